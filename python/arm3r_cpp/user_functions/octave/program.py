"""Calls a function of a MATLAB text through Octave, in the confined process."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..programs import Call, Edit, Given, ProgramError, Unread
from .interpreter import Interpreter
from .source import OWN, constants_of, functions_alone, headers_of

Floats = NDArray[np.float64]
# What they draw changes no value, and here is nothing to draw on.
_DRAWING: tuple[str, ...] = ("axis", "close", "drawnow", "figure", "grid", "hold", "legend", "plot", "plot3", "subplot")
_DRAWING += ("title", "view", "xlabel", "ylabel", "zlabel")
_NO_NUMBERS = "arm3r:numbers"
_NO_MEMORY = "out of memory"
# For each column of x__ one of a__; d__ is the size of what the function returns.
_ROWS = """
{given}
d__ = []; r__ = cell(1, {asked});
for k__ = 1:size(x__, 2)
  [r__{{:}}] = {function}({arguments});
  if numel({chosen}) == 1
    v__ = r__{{{chosen}}};
  else
    if ! all(cellfun(@(v) isscalar(v) && (isnumeric(v) || islogical(v)), r__))
      error('{no_numbers}', 'returns several outputs that are no scalars');
    end
    v__ = cellfun(@double, r__(:));
  end
  if ! (isnumeric(v__) || islogical(v__))
    error('{no_numbers}', 'returns a %s instead of numbers', class(v__));
  elseif iscomplex(v__)
    error('{no_numbers}', 'returns complex numbers');
  elseif ndims(v__) > 2 || isempty(v__)
    error('{no_numbers}', 'returns an array of %s numbers', strrep(num2str(size(v__)), '  ', ' x '));
  elseif k__ > 1 && ! isequal(size(v__), d__)
    error('{no_numbers}', 'returns arrays of different shapes at different states');
  elseif k__ == 1
    d__ = size(v__); a__ = zeros(2 + prod(d__), size(x__, 2)); a__(1, :) = d__(1); a__(2, :) = d__(2);
  end
  a__(3:end, k__) = double(full(v__))(:);
end
"""


class OctaveProgram:
    """A function of a MATLAB text, which Octave evaluates."""

    def __init__(self, text: str, function: str, library: str, folder: str) -> None:
        self.text, self.function, self.library, self.folder = text, function, library, folder
        self.headers = headers_of(text)
        self._interpreter: Interpreter | None = None
        self._defined: str | None = None

    def arguments(self) -> tuple[list[str], list[str]]:
        return self.headers[self.function].inputs, []

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """A row of numbers for each row of the table, in the shape that the function returns.

        Raises:
            ProgramError: it returns no numbers.
            Unread: Octave raised an error.
        """
        found = []
        for numbers, rows in _by_numbers(call.lifted, table):
            self._define(numbers)
            found.append(self._rows(call, rows))
        if len({one.shape[1:] for one in found}) > 1:
            raise ProgramError("returns arrays of different shapes at different states")
        return np.concatenate(found)

    def _define(self, numbers: Mapping[str, float]) -> None:
        """Have Octave read the text, with other numbers in the place of constants."""
        text = self.text
        places = [one for one in constants_of(text) if one.name in numbers]
        for one in sorted(places, key=lambda one: -one.start):
            text = f"{text[: one.start]}({numbers[one.name]!r}){text[one.end :]}"
        if text != self._defined:
            self._asked(functions_alone(text))
            self._defined = text

    def _rows(self, call: Call, table: Floats) -> Floats:
        several = len(self.headers[self.function].outputs)
        asked = several if call.output is None else call.output + 1
        code = _ROWS.format(
            given=_given_to(call),
            function=self.function,
            arguments=", ".join(_argument(number, slot) for number, slot in enumerate(call.slots)),
            asked=asked,
            chosen=asked if call.output is not None or asked == 1 else f"1:{asked}",
            no_numbers=_NO_NUMBERS,
        )
        shaped = f"x__ = reshape(x__, {table.shape[1]}, {len(table)});\n"
        found = self._asked(shaped + code, np.ascontiguousarray(table).tobytes())
        rows, columns = map(int, found[0, :2])
        values = np.swapaxes(found[:, 2:].reshape(-1, columns, rows), 1, 2)
        return values[:, :, 0] if columns == 1 else values

    def _asked(self, code: str, numbers: bytes = b"") -> Floats:
        """What Octave answers, a row for each column of its numbers.

        Raises:
            ProgramError: the function returns no numbers.
            Unread: Octave raised an error.
        """
        if self._interpreter is None:
            self._interpreter = self._started()
        answer = self._interpreter.ask(code, numbers)
        if answer.error:
            self._fail(answer.error)
        return np.frombuffer(answer.numbers).reshape(answer.columns, -1) if answer.columns else np.zeros((0, 0))

    def _started(self) -> Interpreter:
        if self.folder:
            os.chdir(self.folder)  # where it looks for functions in files of their own
        interpreter = Interpreter(self.library)
        for name in _DRAWING:
            if not os.path.exists(os.path.join(self.folder, f"{name}.m")):
                interpreter.ask(f"function varargout = {name}(varargin), varargout = cell(1, nargout); end")
        return interpreter

    def _fail(self, error: str) -> None:
        """
        Raises:
            ProgramError: the function returns no numbers.
            Unread: Octave raised an error.
        """
        stack, _, message = error.partition("\n\n")
        identifier, *calls = stack.split("\n")
        if identifier == _NO_NUMBERS:
            raise ProgramError(message)
        if message.startswith(_NO_MEMORY):
            raise MemoryError
        if message.startswith("parse error"):
            message = message.partition(">>>")[0].removeprefix("parse error:")
        message = message.replace(OWN, "")
        words = re.sub(r" near line \d+, column \d+", "", " ".join(message.split()))
        file, line = self._place(calls)
        raise Unread(f"Octave says{f' in {file}' if file else ''}: {words}", line)

    def _place(self, calls: list[str]) -> tuple[str, int | None]:
        """Of the innermost function of the user's: its file, where that is another one, and the line."""
        for call in calls:
            path, name, line = call.rsplit("|", 2)
            if int(line) < 1:  # where calls are too deep
                continue
            if not path and name in self.headers:
                return "", self.headers[name].line + int(line) - 1
            if path and os.path.dirname(path) in (self.folder, os.path.realpath(self.folder)):
                return f"{os.path.basename(path)}:{line}", None
        return "", None


def _by_numbers(lifted: Mapping[str, int], table: Floats) -> Iterator[tuple[dict[str, float], Floats]]:
    """Parts of the table in each of which lifted constants have the same values."""

    def numbers(row: Floats) -> list[float]:
        return [float(row[column]) for column in lifted.values()]

    start = 0
    for values, rows in groupby(table, numbers):
        count = len(list(rows))
        yield dict(zip(lifted, values, strict=True)), table[start : start + count]
        start += count


def _argument(number: int, slot: Any) -> str:
    if isinstance(slot, Given):
        return f"g{number}__"
    return f"x__({slot + 1}, k__)" if isinstance(slot, int) else f"x__([{' '.join(str(one + 1) for one in slot)}], k__)"


def _given_to(call: Call) -> str:
    """The assignments of arguments that are the same in each row, and of global variables."""
    own = [f"g{number}__ = {literal(slot.value)};" for number, slot in enumerate(call.slots) if isinstance(slot, Given)]
    outside = [f"global {name}; {name} = {literal(value)};" for name, value in call.outside.items()]
    return "\n".join([*own, *outside])


def literal(value: Any) -> str:
    """A number, a list of numbers as a column, lists of them as rows, or a structure, in Octave's words."""
    if isinstance(value, dict):
        return f"struct({', '.join(f'{name!r}, {literal(inner)}' for name, inner in value.items())})"
    if isinstance(value, list):
        rows = (" ".join(map(_number, one)) if isinstance(one, list) else _number(one) for one in value)
        return f"[{'; '.join(rows)}]"
    return _number(value)


def _number(value: Any) -> str:
    return repr(float(value)) if math.isfinite(value) else "NaN"
