"""Runs read from files: to the same bits as they were written, or an error that names file and line."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any, NamedTuple, TextIO

import numpy as np

from ._native import Floats
from .errors import UsageError
from .fnv import fnv1a64


class Parts(NamedTuple):
    """What a run is made of."""

    columns: dict[str, Floats]
    units: dict[str, str]
    summary: dict[str, Any]
    report: str | None


def read(path: Path) -> Parts:
    """The run in NAME.csv, with NAME.json beside it, or in NAME.npz.

    Raises:
        UsageError: a file cannot be read, or does not hold a whole run as it was written.
    """
    readers = {".csv": _read_csv, ".npz": _read_npz}
    if path.suffix not in readers:
        raise UsageError(f"{path}: a file named .csv or .npz is needed, got {path.suffix!r}", code="usage")
    try:
        parts = readers[path.suffix](path)
    except OSError as error:
        hint = "a run is NAME.csv with NAME.json beside it, or NAME.npz"
        raise _unreadable(error.filename or path, f"cannot be read: {error.strerror or error}; {hint}") from error
    _verify(parts, path)
    return parts


def _unreadable(place: object, why: str) -> UsageError:
    return UsageError(f"{place}: {why}", code="file.run")


def _read_csv(path: Path) -> Parts:
    with path.open(encoding="utf-8", errors="replace") as file:
        names = file.readline().rstrip("\n").split(",")
        if names[0] != "t":
            raise _unreadable(f"{path}:1", f"a line of column names, from t on, is needed, got {names[0]!r}")
        data = np.fromiter(_numbers(path, file, names), np.float64).reshape(-1, len(names))
    summary_path = path.with_suffix(".json")
    summary, units = _summary(summary_path.read_text(encoding="utf-8", errors="replace"), summary_path)
    return Parts(dict(zip(names, np.ascontiguousarray(data.T), strict=True)), units, summary, None)


def _numbers(path: Path, file: TextIO, names: Sequence[str]) -> Iterator[float]:
    for number, line in enumerate(file, 2):
        fields = line.split(",")
        if len(fields) != len(names) or not line.endswith("\n"):
            why = f"a whole line of {len(names)} numbers is needed, got {len(fields)}"
            raise _unreadable(f"{path}:{number}", why + ("" if line.endswith("\n") else "; the file ends within it"))
        for name, field in zip(names, fields, strict=True):
            try:
                yield float(field)
            except ValueError:
                raise _unreadable(f"{path}:{number}", f"{name}: a number is needed, got {field.strip()!r}") from None


def _read_npz(path: Path) -> Parts:
    try:
        with path.open("rb") as stream, np.load(stream) as file:
            names, text, report = (file[key].tolist() for key in ("columns", "summary", "report"))
            columns = dict(zip(names, np.require(file["data"], np.float64, ["C"]), strict=True))
    except OSError:
        raise
    except Exception as error:  # what numpy and zipfile raise for a damaged file is not a closed list
        raise _unreadable(path, "not a run that to_npz wrote, or damaged") from error
    summary, units = _summary(text, path)
    return Parts(columns, units, summary, report or None)


def _summary(text: str, path: Path) -> tuple[dict[str, Any], dict[str, str]]:
    """The summary, and the columns' units that stand in it."""
    try:
        summary = json.loads(text)
        return summary, {column["name"]: column["unit"] for column in summary["columns"]}
    except json.JSONDecodeError as error:
        raise _unreadable(f"{path}:{error.lineno}:{error.colno}", f"not JSON: {error.msg}") from error
    except (KeyError, TypeError) as error:
        raise _unreadable(path, "not the summary of a run: its columns are not listed") from error


def _verify(parts: Parts, path: Path) -> None:
    """Refuse what is not, number by number, what the summary was written for."""
    for found, needed in zip_longest(parts.columns, parts.units):
        _compare(path, "column", found, needed)
    _compare(path, "rows", len(parts.columns["t"]), parts.summary.get("rows"))
    _compare(path, "hash", fnv1a64(parts.columns.values()), parts.summary.get("hash"))


def _compare(path: Path, what: str, found: object, needed: object) -> None:
    if found != needed:
        raise _unreadable(path, f"not as it was written: {what}: {needed} in the summary, {found} in the file")
