"""Derivatives by the symbols of a script, by differences between states around each state.

A script of MATLAB's symbolic toolbox is evaluated in numbers, as any other program. Where it differentiates, it is
evaluated at more states: each symbol a little larger and smaller in five steps. The central difference of tenth order
between them is exact to rounding for what formulas of arms hold; for what is quadratic, one step is. What has been
differentiated is known at the states themselves alone, and is NaN around them: another derivative of it needs another
level of states, around those of the level before.
"""

from __future__ import annotations

import numpy as np

from ..programs import Unread
from .values import Floats

STEP = 0.02
WEIGHTS = {1: (1 / 2,), 5: (5 / 6, -5 / 21, 5 / 84, -5 / 504, 1 / 1260)}
"""Of the differences over 2, 4, ... steps, by their number; in units of a step."""
MOST_STATES = 400_000
_BASE, _MARK, _FIRST = 0, 1, 2
"""Places along a level: the state itself, once more so that it can be marked as used, and those around it."""


class Stencil:
    """The states around each state of a table, in levels: how many steps there are along which symbols."""

    def __init__(self, levels: list[dict[str, int]]) -> None:
        self.levels = levels
        self.sizes = [_FIRST + 2 * sum(level.values()) for level in levels]
        self.missing: set[tuple[int, str]] = set()
        """Level and symbol of derivatives that were asked for, and are not there."""
        self.curved: set[tuple[int, str]] = set()
        """Those for which one step is not enough."""

    @property
    def states(self) -> int:
        """For each state of the table."""
        return int(np.prod(self.sizes))

    def spread(self, table: Floats, columns: dict[str, int]) -> Floats:
        """
        Raises:
            Unread: a symbol is no column of the table.
        """
        for level, size in zip(self.levels[::-1], self.sizes[::-1], strict=True):
            change = np.zeros((size, table.shape[1]))
            for symbol, steps in level.items():
                if symbol not in columns:
                    raise Unread(f"differentiates by {symbol}, which is held at one value")
                for step in range(steps):
                    place = self._place(level, symbol) + 2 * step
                    change[[place, place + 1], columns[symbol]] = STEP * (step + 1), -STEP * (step + 1)
            table = (change[:, None, :] + table[None]).reshape(-1, table.shape[1])
        return table

    @staticmethod
    def _place(level: dict[str, int], symbol: str) -> int:
        symbols = list(level)
        return _FIRST + 2 * sum(level[one] for one in symbols[: symbols.index(symbol)])

    def derivative(self, array: Floats, symbol: str) -> Floats:
        """By a symbol, at the states themselves; where that is missing, any number."""
        if len(array) == 1:
            return np.zeros_like(array)  # a constant
        around = array.reshape(*self.sizes, -1, *array.shape[1:])
        for number in range(len(self.levels)):
            moved = np.moveaxis(around, number, 0)
            others = (_BASE,) * (len(self.levels) - 1)
            if np.isnan(moved[_MARK][others]).any() and not np.isnan(moved[_BASE][others]).any():
                continue  # this level is used up
            found = np.full_like(moved, np.nan)
            found[_BASE] = self._slope(moved, number, symbol)
            return np.moveaxis(found, 0, number).reshape(array.shape)
        self.missing.add((len(self.levels), symbol))
        return np.full_like(array, 0.5)

    def _slope(self, moved: Floats, number: int, symbol: str) -> Floats:
        level = self.levels[number]
        if symbol not in level:
            self.missing.add((number, symbol))
            return np.full_like(moved[_BASE], 0.5)
        first = self._place(level, symbol)
        changes = [moved[first + 2 * step] - moved[first + 2 * step + 1] for step in range(level[symbol])]
        slope = sum(weight * change for weight, change in zip(WEIGHTS[level[symbol]], changes, strict=True)) / STEP
        by_one = changes[0] / (2 * STEP)
        if np.nanmax(np.abs(slope - by_one), initial=0) > 1e-9 * np.nanmax(np.abs(moved[_BASE]), initial=1e-3):
            self.curved.add((number, symbol))
        return np.asarray(slope)
