"""Scripts of MATLAB's symbolic toolbox: each variable is a function of the symbols that it is made of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...errors import UsageError
from ..expressions import Node, Number
from ..programs import Call, ProgramError, Unread
from .indexing import flat
from .program import Divided, MatlabProgram, Workspace
from .reader import read
from .symbols import MOST_STATES, WEIGHTS, Stencil
from .syntax import Function, Statement
from .values import Floats, as_numbers, stacked

_GOLDEN = 0.6180339887498949  # its multiples modulo 1 are apart


def program_of(
    text: str, file: str, function: str | None, folder: str | None, likely: Callable[[list[str]], str]
) -> MatlabProgram:
    """The program of a file.

    Args:
        function: the one to evaluate, or the variable of a symbolic script; None: the first function.
        folder: where functions in files of their own are looked for; None: nowhere.
        likely: which variable of a symbolic script is evaluated where none is named.

    Raises:
        UnjudgedError: the file holds what is not read.
        UsageError: it has no such function.
    """
    functions = read(text, file)
    variables = [name for name, one in functions.items() if one.is_script]
    if not variables:
        return MatlabProgram(text, file, function, folder, functions=functions)
    chosen = function or likely(variables)
    if chosen not in functions:
        raise UsageError(f"{file}: there is no variable {chosen}; it has {', '.join(functions)}")
    return SymbolicScript(text, file, chosen, folder, functions=functions)


class SymbolicScript(MatlabProgram):
    """The script is evaluated in numbers; derivatives come from states around each state (`Stencil`)."""

    of_program = (
        *MatlabProgram.of_program,
        *("jacobian", "gradient", "hessian", "diff", "subs", "simplify", "expand", "collect", "factor", "combine"),
        *("rewrite", "simplifyFraction", "vpa", "sym", "formula", "matlabFunction"),
    )

    can_trace = False

    def __init__(self, *given: Any, functions: dict[str, Function]) -> None:
        super().__init__(*given, functions=functions)
        self.functions = {
            name: one for name, one in self.functions.items() if name == self.function or not one.is_script
        }
        self._stencil = Stencil([])
        self._levels: list[dict[str, int]] | None = None
        self._symbols: dict[str, Floats] = {}
        self._place = 0
        """Of the statement that is evaluated, among those of the script."""
        self._differentiated: set[tuple[str, ...]] = set()
        """By which symbols together."""
        self._substituted: set[str] = set()
        """The symbols that other values are put for."""
        self._differentiated_away: list[str] = []
        """Symbols on which the result does not depend: rates in the second derivatives of the kinetic energy, and those
        that numbers are put for."""
        if self.functions[self.function].is_script:
            self._differentiated_away = self._without_effect()

    @property
    def arguments(self) -> list[str]:
        return [name for name in super().arguments if name not in self._differentiated_away]

    @property
    def states(self) -> int:
        """How many states are computed for each that is asked for."""
        return Stencil(self._levels or []).states

    def _without_effect(self) -> list[str]:
        """Of the lists of symbols by which the script differentiates, those of which none matters; and all that others
        are put for and that do not matter."""
        names = super().arguments
        values = np.random.default_rng(1).uniform(0.3, 0.9, (1, len(names)))
        call = Call(tuple(range(len(names))), {})

        def has_effect(name: str) -> bool:
            other = self._evaluate(call, values + 0.2 * (np.arange(len(names)) == names.index(name)))
            return bool(np.abs(other - result).max(initial=0) > 1e-9 * np.abs(result).max(initial=1e-3))

        try:
            result = self._evaluate(call, values)
            lists = [symbols for symbols in sorted(self._differentiated) if not any(map(has_effect, symbols))]
            lists += [(name,) for name in names if name in self._substituted and not has_effect(name)]
        except (ProgramError, ArithmeticError, ValueError):
            return []  # what fails here fails again where it is judged
        return list(dict.fromkeys(name for symbols in lists for name in symbols))

    def _evaluate(self, call: Call, table: Floats) -> Floats:
        """At states around those of the table too, as many as the derivatives need."""
        call, table = self._with_hidden(call, table)
        names = self.functions[self.function].inputs
        columns = {name: slot for name, slot in zip(names, call.slots, strict=True) if isinstance(slot, int)}
        if self._levels is None:
            self._levels = self._levels_needed(call, table.shape[1], columns)
        stencil = self._stencil = Stencil(self._levels)
        if stencil.states > MOST_STATES:
            raise Unread("differentiates more often, or by more symbols, than is read")
        count = max(1, MOST_STATES // stencil.states)  # of states at once
        parts = [table[first : first + count] for first in range(0, len(table), count)]
        found = [
            self._values_at(call, np.vstack([one, self._apart(table.shape[1])]), columns)[: len(one)] for one in parts
        ]
        if stencil.missing:  # an edit differentiates what the text does not
            raise ProgramError("differentiates more often than before")
        return np.concatenate(found)

    @staticmethod
    def _apart(width: int) -> Floats:
        """A state in which all symbols differ, so that each is known by its values."""
        return np.random.default_rng(0).uniform(0.3, 0.9, (1, width))

    def _values_at(self, call: Call, table: Floats, columns: dict[str, int]) -> Floats:
        try:
            return super()._evaluate(call, self._stencil.spread(table, columns))
        except Divided:
            raise Unread("a condition or an index depends on a symbol, which has no single value") from None

    def _levels_needed(self, call: Call, width: int, columns: dict[str, int]) -> list[dict[str, int]]:
        """By which symbols the script differentiates, what is a derivative already in another level, in how many steps.

        Each round adds what was missing in the one before.
        """
        levels: list[dict[str, int]] = []
        while True:
            stencil = self._stencil = Stencil([*levels, {}])
            if stencil.states > MOST_STATES:
                raise Unread("differentiates more often, or by more symbols, than is read")
            self._values_at(call, self._apart(width), columns)
            levels = [
                {symbol: steps if (number, symbol) in stencil.curved else 1 for symbol, steps in level.items()}
                for number, level in enumerate(levels)
            ]
            if not stencil.missing:
                return levels
            for number, symbol in sorted(stencil.missing):
                levels += [{}] * (number + 1 - len(levels))
                levels[number] = levels[number] | {symbol: max(WEIGHTS)}

    def _with_hidden(self, call: Call, table: Floats) -> tuple[Call, Floats]:
        """With a column for each symbol that is no argument."""
        hidden = self._differentiated_away
        if not hidden:
            return call, table
        given, width = iter(call.slots), table.shape[1]
        slots = tuple(
            width + hidden.index(name) if name in hidden else next(given)
            for name in self.functions[self.function].inputs
        )
        apart = 0.3 + 0.6 * (np.arange(1, len(hidden) + 1) * _GOLDEN % 1)  # each symbol is known by its values
        return call._replace(slots=slots), np.hstack([table, np.tile(apart, (len(table), 1))])

    def _outputs(self, function: Function, inputs: list[Any], variables: Workspace, *given: Any) -> list[Any]:
        if function.is_script:
            self._symbols = dict(zip(function.inputs, inputs, strict=True))
        return super()._outputs(function, inputs, variables, *given)

    def _execute(self, statements: list[Statement], variables: dict[str, Any]) -> None:
        script = self.functions[self.function].body
        if statements is not script:
            return super()._execute(statements, variables)
        for self._place in range(len(script)):
            super()._execute([script[self._place]], variables)

    # ---- functions of the toolbox: their value at each state ---------------------------------------------------------

    def _same(self, node: Node, variables: dict[str, Any]) -> Any:
        """`simplify(J)` and its like have the value of their first argument."""
        if not node.parts:
            raise ProgramError(f"{node.word} takes an expression")
        value = self._value(node.parts[0], variables)
        if isinstance(value, str):
            raise Unread(f"{node.word} of a text is not read; declare the symbol by syms")
        return value

    _simplify = _expand = _collect = _factor = _combine = _rewrite = _simplifyFraction = _vpa = _sym = _formula = _same
    _matlabFunction = _same

    def _elements(self, node: Node, variables: dict[str, Any]) -> list[Any]:
        """Of a row, a column or a cell array."""
        value = self._value(node, variables)
        if isinstance(value, np.ndarray):
            return list(flat(as_numbers(value)).T[:, :, None, None])
        if not isinstance(value, list):
            raise Unread(f"{self.text[node.start : node.end]!r} is no list of symbols or numbers")
        return value

    def _symbols_in(self, node: Node, variables: dict[str, Any]) -> list[str]:
        """
        Raises:
            Unread: one of the elements is no symbol.
        """
        found = []
        for element in self._elements(node, variables):
            name = next((name for name, own in self._symbols.items() if np.array_equal(own, element)), None)
            if name is None:
                words = "an element is no symbol that `syms` or sym('name') declares by its own name"
                raise Unread(f"in {self.text[node.start : node.end]!r} {words}")
            found.append(name)
        return found

    def _of_symbols(self, node: Node, variables: dict[str, Any]) -> tuple[Floats, list[str]]:
        if len(node.parts) < 2:
            raise Unread(f"{node.word} is read with the symbols by which it differentiates: {node.word}(f, [q1 q2 q3])")
        symbols = self._symbols_in(node.parts[1], variables)
        self._differentiated.add(tuple(symbols))
        return self._array(node.parts[0], variables), symbols

    def _jacobian(self, node: Node, variables: dict[str, Any]) -> Floats:
        """A row for each element of the first argument, a column for each symbol."""
        value, symbols = self._of_symbols(node, variables)
        column = flat(value)[:, :, None]
        return stacked([self._stencil.derivative(column, symbol) for symbol in symbols], 2)

    def _gradient(self, node: Node, variables: dict[str, Any]) -> Floats:
        return np.swapaxes(self._jacobian(node, variables), 1, 2)

    def _hessian(self, node: Node, variables: dict[str, Any]) -> Floats:
        value, symbols = self._of_symbols(node, variables)
        slopes = stacked([self._stencil.derivative(value, symbol) for symbol in symbols], 1)
        return stacked([self._stencil.derivative(slopes, symbol) for symbol in symbols], 2)

    def _diff(self, node: Node, variables: dict[str, Any]) -> Floats:
        """diff(f, q1), diff(f, q1, 2), diff(f, q1, q2)."""
        value, symbols = self._of_symbols(node, variables)
        for part in node.parts[2:]:
            again = (
                symbols[-1:] * (int(part.value) - 1) if isinstance(part, Number) else self._symbols_in(part, variables)
            )
            symbols += again
        for symbol in symbols:
            value = self._stencil.derivative(value, symbol)
        return value

    def _subs(self, node: Node, variables: dict[str, Any]) -> Any:
        """The value with other values of symbols: the script up to here is evaluated again with them."""
        if len(node.parts) == 1:
            return self._value(node.parts[0], variables)
        if len(node.parts) != 3:
            raise Unread("subs is read with symbols and their values: subs(J, [a2 a3], [1 1])")
        symbols = self._symbols_in(node.parts[1], variables)
        values = self._elements(node.parts[2], variables)
        values = values * len(symbols) if len(values) == 1 else values
        if len(values) != len(symbols):
            raise ProgramError(f"subs has {len(symbols)} symbols and {len(values)} values")
        self._substituted |= set(symbols)
        before, place = self._symbols, self._place
        self._symbols = before | dict(zip(symbols, values, strict=True))
        others = Workspace(self.functions[self.function])
        others.update(self._symbols)
        try:
            for self._place in range(place):
                super()._execute([self.functions[self.function].body[self._place]], others)
            return self._value(node.parts[0], others)
        finally:
            self._symbols, self._place = before, place
