"""Entries of a formula as sums of sines and cosines of the joint angles, by a discrete Fourier transform."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ..._native import Floats

Sampler = Callable[[Floats], Floats]
"""Joint vectors (S, n) to values (arms, S, entries)."""
_POINTS = 16  # along one joint, from which its order is found
_OFFSET = 0.137  # of the grid's angles: no point of it is a special pose


@dataclass(frozen=True)
class Wave:
    """cos or sin of an integer combination of angles, or a power of one joint variable; the empty wave is 1."""

    kind: str = ""
    """ "C", "S", "C deg", "S deg" or "power" """
    joints: tuple[int, ...] = ()
    factors: tuple[int, ...] = ()

    def __str__(self) -> str:
        names = [f"q{joint + 1}" for joint in self.joints]
        if self.kind == "power":
            return names[0] if self.factors == (1,) else f"{names[0]}^{self.factors[0]}"
        if set(self.factors) == {1} and self.kind in ("C", "S"):
            return self.kind + "".join(str(joint + 1) for joint in self.joints)
        parts = [
            f"{'-' if f < 0 else '+'} {'' if abs(f) == 1 else f'{abs(f)} '}{name}"
            for f, name in zip(self.factors, names, strict=True)
        ]
        text = " ".join(parts).removeprefix("+ ").replace("- ", "-", 1 if parts[0].startswith("-") else 0)
        return f"{'cos' if self.kind[0] == 'C' else 'sin'}({text}{' deg' if 'deg' in self.kind else ''})"

    def at(self, q: Floats) -> Floats:
        """Its value at joint vectors (S, n)."""
        if not self.joints:
            return np.ones(len(q))
        if self.kind == "power":
            return q[:, self.joints[0]] ** self.factors[0]
        angle = q[:, list(self.joints)] @ np.array(self.factors, float)
        angle = np.deg2rad(angle) if "deg" in self.kind else angle
        return np.cos(angle) if self.kind[0] == "C" else np.sin(angle)


@dataclass
class Axis:
    """A group of joints whose angles occur as sums: its grid, its waves, and the map from values to coefficients."""

    joints: tuple[int, ...]
    points: Floats
    waves: list[Wave]
    inverse: Floats


def axis(joints: tuple[int, ...], kind: str, orders: tuple[int, ...], total: int) -> Axis:
    """kind: "angle", "degree" (an angle in degrees) or "power" (a length, or an angle that stands by itself)."""
    if kind == "power":
        points = np.array([[-0.9], [0.2], [1.1]])[: orders[0] + 1]
        waves = [Wave(), *(Wave("power", joints, (power,)) for power in range(1, len(points)))]
    else:
        period, suffix = (360.0, " deg") if kind == "degree" else (2 * np.pi, "")
        points = np.array(list(product(*(_circle(order, period) for order in orders))))
        waves = [Wave()]
        for factors in product(*(range(-order, order + 1) for order in orders)):
            first = next((factor for factor in factors if factor), 0)
            if first > 0:
                used = [(joint, factor) for joint, factor in zip(joints, factors, strict=True) if factor]
                places, numbers = tuple(joint for joint, _ in used), tuple(factor for _, factor in used)
                waves += [Wave(f"{letter}{suffix}", places, numbers) for letter in "CS"]
    q = np.zeros((len(points), total))
    q[:, list(joints)] = points
    return Axis(joints, points, waves, np.linalg.inv(np.stack([wave.at(q) for wave in waves], axis=1)))


@dataclass
class Spectrum:
    """Coefficients (arms, waves, entries) of products of waves, one of each axis."""

    waves: list[tuple[Wave, ...]]
    coefficients: Floats

    def at(self, q: Floats) -> Floats:
        """The values (arms, S, entries) that the coefficients give."""
        values = np.stack(
            [np.prod([np.ones(len(q)), *(wave.at(q) for wave in waves)], axis=0) for waves in self.waves], axis=1
        )
        return np.einsum("sw,kwe->kse", values, self.coefficients)


def spectrum(sampler: Sampler, axes: Sequence[Axis], total: int) -> Spectrum:
    """One evaluation at each point of the grid that the axes span."""
    grid = list(product(*(one.points for one in axes)))
    q = np.zeros((len(grid), total))
    for row, points in enumerate(grid):
        for one, values in zip(axes, points, strict=True):
            q[row, list(one.joints)] = values
    values = sampler(q)
    arms, entries = len(values), values.shape[2]
    values = values.reshape(arms, *(len(one.points) for one in axes), entries)
    for place, one in enumerate(axes, start=1):
        values = np.moveaxis(np.tensordot(one.inverse, values, axes=(1, place)), 0, place)
    waves = [tuple(wave for wave in waves if wave.joints) for waves in product(*(one.waves for one in axes))]
    return Spectrum(waves, values.reshape(arms, -1, entries))


def _circle(order: int, period: float) -> Floats:
    return (np.arange(2 * order + 1) / (2 * order + 1) + _OFFSET) * period


def kinds_of_axes(
    sampler: Sampler, revolute: Sequence[bool], entry: int, least: float = 1e-3
) -> list[tuple[str, int]] | None:
    """For each joint what the entry is in it ("angle", "degree", "power"), and its order; None where it is neither."""
    base = np.random.default_rng(11).uniform(-2, 2, (2, len(revolute)))
    kinds = []
    for joint, turns in enumerate(revolute):
        found = _kind_of_axis(sampler, base, joint, turns, entry, least)
        if found is None:
            return None
        kinds.append(found)
    return kinds


def _kind_of_axis(
    sampler: Sampler, base: Floats, joint: int, turns: bool, entry: int, least: float
) -> tuple[str, int] | None:
    def along(steps: Floats) -> Floats:
        """(arms, bases, steps)"""
        q = np.repeat(base, len(steps), axis=0)
        q[:, joint] += np.tile(steps, len(base))
        values = sampler(q)[..., entry]
        return values.reshape(len(values), len(base), len(steps))

    for kind, period in (("angle", 2 * np.pi), ("degree", 360.0)):
        values = along(np.append(np.arange(_POINTS) / _POINTS, 1.0) * period)
        scale = least + np.abs(values).max()
        if (turns or kind == "degree") and np.abs(values[..., -1] - values[..., 0]).max() < 1e-9 * scale:
            harmonics = np.abs(np.fft.rfft(values[..., :-1])).max(axis=(0, 1)) / _POINTS
            orders = np.flatnonzero(harmonics > 1e-11 * scale)
            return kind, int(orders.max(initial=0))
    values = along(np.arange(4.0))
    limit = 1e-9 * (least + np.abs(values).max())
    for order in range(3):
        values = np.diff(values)
        if np.abs(values).max() < limit:
            return "power", order
    return None


def read(
    sampler: Sampler,
    groups: Sequence[Sequence[int]],
    revolute: Sequence[bool],
    entry: int,
    *,
    few_arms: Sampler | None = None,
    scale: float = 0.0,
    budget: int = 3000,
) -> Spectrum | None:
    """The spectrum of one entry, confirmed at random states; None where it is no such sum.

    Args:
        few_arms: the sampler for a few of its arms, which show of what kind each joint is; all confirm it.
        scale: of what the entry is a part of; what is very small beside it is rounding.
        budget: the most points of a grid that is tried.
    """
    kinds = kinds_of_axes(few_arms or sampler, revolute, entry, max(scale, 1e-3))
    if kinds is None:
        return None
    n = len(revolute)
    split: list[tuple[tuple[int, ...], str]] = []
    for group in groups:
        angles = tuple(joint for joint in group if kinds[joint][0] == "angle")
        split += [((joint,), kinds[joint][0]) for joint in group if kinds[joint][0] != "angle"]
        split += [(angles, "angle")] if angles else []
    points = np.prod([order + 1 if kind == "power" else 2 * order + 1 for kind, order in kinds])
    if points > budget or max(order for _, order in kinds) >= _POINTS // 2:
        return None
    axes = [axis(joints, kind, tuple(kinds[joint][1] for joint in joints), n) for joints, kind in sorted(split)]
    found = spectrum(lambda q: sampler(q)[..., [entry]], axes, n)
    probe = np.random.default_rng(12).uniform(-3, 3, (12, n))
    due = sampler(probe)[..., [entry]]
    limit = 1e-8 * (np.abs(due).max() + 1e-6 + scale)
    return found if np.abs(found.at(probe) - due).max() < limit else None
