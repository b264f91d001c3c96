"""Runs read from files: to the same bits as they were written, or an error that names file and line."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any, NamedTuple, TextIO

import numpy as np

from .._files import regular, replacing
from .._hash import fnv1a64
from .._messages import place
from .._native import Floats
from ..errors import UsageError

_SUMMARY, _REPORT = "summary.json", "report.txt"  # beside the arrays of the columns


class RunData(NamedTuple):
    """The data of a run, as it is stored in a file."""

    columns: dict[str, Floats]
    units: dict[str, str]
    summary: dict[str, Any]
    report: str | None


def read(path: Path) -> RunData:
    """The run in NAME.csv, with NAME.json beside it, or in NAME.npz.

    Raises:
        UsageError: a file cannot be read, or does not hold a whole run as it was written.
    """
    readers = {".csv": _read_csv, ".npz": _read_npz}
    if path.suffix not in readers:
        raise UsageError(f"{path}: a file named .csv or .npz is needed, got {path.suffix!r}", code="usage")
    try:
        parts = readers[path.suffix](regular(path))
    except OSError as error:
        hint = "a run is NAME.csv with NAME.json beside it, or NAME.npz"
        raise _unreadable(error.filename or path, f"cannot be read: {error.strerror or error}; {hint}") from error
    _verify(parts, path)
    return parts


def _unreadable(where: object, why: str) -> UsageError:
    return UsageError(f"{where}: {why}", code="file.run")


def _read_csv(path: Path) -> RunData:
    with path.open(encoding="utf-8", errors="replace") as file:
        names = file.readline().rstrip("\n").split(",")
        if names[0] != "t":
            raise _unreadable(place(path, 1), f"a line of column names, from t on, is needed, got {names[0]!r}")
        data = np.fromiter(_numbers(path, file, names), np.float64).reshape(-1, len(names))
    summary_path = path.with_suffix(".json")
    text = regular(summary_path).read_text(encoding="utf-8", errors="replace")
    summary, units = _summary(text, summary_path)
    return RunData(dict(zip(names, np.ascontiguousarray(data.T), strict=True)), units, summary, None)


def _numbers(path: Path, file: TextIO, names: Sequence[str]) -> Iterator[float]:
    for number, line in enumerate(file, 2):
        fields = line.split(",")
        if len(fields) != len(names) or not line.endswith("\n"):
            why = f"a whole line of {len(names)} numbers is needed, got {len(fields)}"
            raise _unreadable(place(path, number), why + ("" if line.endswith("\n") else "; the file ends within it"))
        for name, field in zip(names, fields, strict=True):
            try:
                yield float(field)
            except ValueError:
                raise _unreadable(place(path, number), f"{name}: a number is needed, got {field.strip()!r}") from None


def write_npz(path: Path, run: RunData) -> None:
    """One file that `numpy.load` reads, whole or not at all: that of `arm3r run -o`, and the report."""
    with replacing(path) as part, zipfile.ZipFile(part, "w") as file:
        for name, column in run.columns.items():
            with file.open(_member(f"{name}.npy"), "w", force_zip64=True) as member:
                np.lib.format.write_array(member, column, allow_pickle=False)
        file.writestr(_member(_SUMMARY), json.dumps(run.summary))
        if run.report:
            file.writestr(_member(_REPORT), run.report)


def _member(name: str) -> zipfile.ZipInfo:
    """Of a time that is always the same, as the bytes of the file are."""
    return zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))


def _read_npz(path: Path) -> RunData:
    try:
        with path.open("rb") as stream, np.load(stream) as file:
            if _SUMMARY in file:
                text, report = file[_SUMMARY].decode(), file[_REPORT].decode() if _REPORT in file else ""
                columns = {name: file[name] for name in file.files if name not in (_SUMMARY, _REPORT)}
            else:  # as to_npz wrote it before
                names, text, report = (file[key].tolist() for key in ("columns", "summary", "report"))
                columns = dict(zip(names, np.require(file["data"], np.float64, ["C"]), strict=True))
    except OSError:
        raise
    except Exception as error:  # what numpy and zipfile raise for a damaged file is not a closed list
        raise _unreadable(path, "not a run that to_npz wrote, or damaged") from error
    summary, units = _summary(text, path)
    return RunData(columns, units, summary, report or None)


def _summary(text: str, path: Path) -> tuple[dict[str, Any], dict[str, str]]:
    """The summary, and the columns' units that stand in it."""
    try:
        summary = json.loads(text)
    except json.JSONDecodeError as error:
        raise _unreadable(place(path, error.lineno, error.colno), f"not JSON: {error.msg}") from error
    except RecursionError as error:
        raise _unreadable(path, "not the summary of a run: its brackets are nested too deep") from error
    if fault := _fault(summary, SUMMARY, "the file"):
        raise _unreadable(path, f"not the summary of a run: {fault}")
    return with_numbers(summary), {column["name"]: column["unit"] for column in summary["columns"]}


def with_numbers(summary: dict[str, Any]) -> dict[str, Any]:
    """JSON has no infinity, and the library writes "inf": here the summary's numbers are numbers, as a batch's are."""

    def number(value: Any) -> Any:
        return float(value) if value in ("inf", "-inf") else value

    metrics = {name: number(value) for name, value in (summary.get("metrics") or {}).items()}
    own = {name: number(summary[name]) for name in ("energy_residual_max", *metrics) if name in summary}
    return {**summary, **own, **({"metrics": metrics} if metrics else {})}


# What readers of a summary rely on: a type, a list of one shape, or a map with at least these keys.
_NUMBER = (int, float)
_THREE = [_NUMBER]
SUMMARY = {
    "name": str,
    "outcome": str,
    "message": str,
    "events": [{"type": str, "t": _NUMBER, "q": _THREE, "qd": _THREE, "tip": _THREE}],
    "checks": [{"name": str, "passed": bool}],
    "warnings": [str],
    "columns": [{"name": str, "unit": str}],
    "scenario": (str, type(None)),
}


def _fault(value: Any, shape: Any, place: str) -> str:
    """Where a value from JSON has not the shape that is needed; "" where it has."""
    if isinstance(shape, Mapping):
        if not isinstance(value, dict):
            return f"{place} is not a map"
        parts = ((value.get(key), part, f"{key} of {place}") for key, part in shape.items())
    elif isinstance(shape, list):
        if not isinstance(value, list):
            return f"{place} is not a list"
        parts = ((item, shape[0], f"item {i} of {place}") for i, item in enumerate(value))
    else:
        return "" if isinstance(value, shape) else f"{place} is missing or of the wrong type"
    return next(filter(None, (_fault(*part) for part in parts)), "")


def _verify(parts: RunData, path: Path) -> None:
    """Refuse columns that are not, number by number, those that the summary was written for."""
    for found, needed in zip_longest(parts.columns, parts.units):
        _compare(path, "column", found, needed)
    _compare(path, "rows", len(parts.columns["t"]), parts.summary.get("rows"))
    _compare(path, "hash", fnv1a64(parts.columns.values()), parts.summary.get("hash"))


def _compare(path: Path, what: str, found: object, needed: object) -> None:
    if found != needed:
        raise _unreadable(path, f"not as it was written: {what}: {needed} in the summary, {found} in the file")
