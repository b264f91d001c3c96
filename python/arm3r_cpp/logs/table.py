"""Reads a file of named columns: arrays, or a text parted by commas, semicolons, tabs or spaces."""

from __future__ import annotations

import codecs
import csv
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._files import regular
from .._messages import place
from .._native import Floats
from ..errors import UsageError
from .arrays import ENDINGS, Cells, read_arrays
from .units import unit_of

MOST_ROWS = 1_000_000
MOST_SHOWN = 80  # characters of a cell, in a message
_COMMENT = ("#", "%")
_ENCODINGS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
_IN_BRACKETS = re.compile(r"[\[(](.*)[\])]")
_NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eEdD][-+]?\d+)?|[-+]?(nan|inf(inity)?)", re.IGNORECASE)


@dataclass
class Table:
    """The cells of a file, as text."""

    file: str
    names: list[str]
    """As they stand in the file; 1, 2, ... where it has none."""
    lines: list[int]
    """Of the rows."""
    rows: Sequence[list[str]]
    decimal_comma: bool
    numbers: Floats | None = None
    """Of a file that holds no text."""

    def column(self, index: int) -> Floats:
        """The numbers of a column; NaN where a cell is empty.

        Raises:
            UsageError: a cell holds no number.
        """
        if self.numbers is not None:
            return self.numbers[:, index]
        found = np.empty(len(self.rows))
        for row, cells in enumerate(self.rows):
            cell = cells[index].strip()
            try:
                found[row] = float((cell.replace(",", ".") if self.decimal_comma else cell) or "nan")
            except ValueError:
                where = place(self.file, self.lines[row])
                text = f"{where}: {self.names[index]} is a number, got {cell[:MOST_SHOWN]!r}"
                raise UsageError(text, code="file.log") from None
        return found


def read_table(path: str | os.PathLike[str]) -> Table:
    """The cells of a file. Blank lines and comments of a text, after # or %, are passed over.

    Raises:
        UsageError: the file cannot be read, or a row has more or fewer cells than the first line.
    """
    file = os.fspath(path)
    if file.endswith(ENDINGS):
        names, numbers = read_arrays(file)
        return Table(file, names, [*range(1, len(numbers) + 1)], Cells(numbers), False, numbers)
    comments, lines = _parted(file, _text(file).splitlines())
    if not lines:
        raise UsageError(f"{file}: the file has no rows", code="file.log")
    separator = _separator(lines[0][1])
    rows = list(_cells(file, lines, separator))
    names = [name.strip() for name in rows[0][1]]
    if all(_is_number(name, separator) for name in names):
        names = _names_in_comment(comments, separator, len(names))
    else:
        rows = rows[1:]
        if rows and (units := _units(rows[0][1], separator)):
            names = [f"{name} [{unit}]" if unit else name for name, unit in zip(names, units, strict=True)]
            rows = rows[1:]
    if not names[-1] and not any(cells[-1].strip() for _, cells in rows):  # each line ends in a separator
        names, rows = names[:-1], [(line, cells[:-1]) for line, cells in rows]
    return Table(file, names, [line for line, _ in rows], [cells for _, cells in rows], separator != ",")


def _text(file: str) -> str:
    try:
        data = regular(Path(file)).read_bytes()
    except OSError as error:
        raise UsageError(f"{file}: this file cannot be read: {error.strerror or error}", code="file.log") from error
    encoding = next((name for mark, name in _ENCODINGS.items() if data.startswith(mark)), "utf-8")
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if "\0" in text:
        raise UsageError(f"{file}: this file cannot be read: it is not text", code="file.log")
    return text


def _parted(file: str, lines: list[str]) -> tuple[list[str], list[tuple[int, str]]]:
    """The comments before the first row, and the rows, each with the number of its line."""
    if len(lines) > MOST_ROWS:
        raise UsageError(f"{file}: a log of at most {MOST_ROWS} lines can be read, got {len(lines)}", code="file.log")
    found = [(number, line) for number, line in enumerate(lines, start=1) if line.strip()]
    first = next((at for at, (_, line) in enumerate(found) if not line.lstrip().startswith(_COMMENT)), len(found))
    comments = [line.lstrip().lstrip("".join(_COMMENT)) for _, line in found[:first]]
    return comments, [(number, line) for number, line in found[first:] if not line.lstrip().startswith(_COMMENT)]


def _separator(line: str) -> str:
    """The character between columns; a space stands for any white space."""
    found = max(";\t,", key=line.count)
    return found if found in line else " "


def _cells(file: str, lines: list[tuple[int, str]], separator: str) -> Iterator[tuple[int, list[str]]]:
    count = 0
    for number, line in lines:
        try:
            cells = line.split() if separator == " " else next(csv.reader([line], delimiter=separator, strict=True))
        except csv.Error as error:
            raise UsageError(f"{place(file, number)}: this row cannot be read: {error}", code="file.log") from None
        count = count or len(cells)
        if len(cells) != count:
            hint = "; decimal commas need another separator, such as ;" if len(cells) == 2 * count else ""
            raise UsageError(
                f"{place(file, number)}: a row has {count} numbers, got {len(cells)}{hint}", code="file.log"
            )
        yield number, cells


def _is_number(cell: str, separator: str) -> bool:
    return _NUMBER.fullmatch(cell.strip()) is not None and not (separator == "," and "," in cell)


def _units(cells: list[str], separator: str) -> list[str] | None:
    """The units in a row of them, none of which is a number; None where it is another row."""
    units = [_IN_BRACKETS.sub(r"\1", cell.strip()).strip() for cell in cells]
    is_other = any(_is_number(cell, separator) for cell in cells) or not any(map(unit_of, filter(None, units)))
    return None if is_other and any(units) else ["-" if unit == "1" else unit for unit in units]


def _names_in_comment(comments: list[str], separator: str, count: int) -> list[str]:
    """Those of the last comment before the numbers that names as many columns; else their numbers, from 1."""
    for comment in reversed(comments):
        for parted in (comment.split(), comment.split(separator)):
            if len(parted) == count:
                return [name.strip() for name in parted]
    return [str(number) for number in range(1, count + 1)]
