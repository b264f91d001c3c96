"""Results of a run: columns, events, checks, and files."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import _native
from .._files import check_ending
from .._messages import no_column
from .._native import Floats, lib
from ..answers.meant_names import Answering, no_attribute
from ..errors import ColumnError, UsageError
from ..rows.names import columns_of, completions, three_of
from .provided import provided
from .run_file import RunData, read, with_numbers, write_npz

if TYPE_CHECKING:
    import pandas
    import xarray


class Event(NamedTuple):
    """A contact made or broken."""

    type: str
    """"make" or "break"."""
    t: float
    """s"""
    q: tuple[float, float, float]
    """rad"""
    qd: tuple[float, float, float]
    """rad/s"""
    tip: tuple[float, float, float]
    """m, base axes"""


class ClosedForm(NamedTuple):
    """What theory says of the contacts of a run, beside the run's own number; `arm3r docs model`, section 9."""

    name: str
    """Of the summary number."""
    unit: str
    own: float
    closed_form: float
    allowed: float
    """How far theory and the tolerance of the method let the two differ."""


class Trust(NamedTuple):
    """How long the joint angles of a run are right; `arm3r docs model` (9.6)."""

    horizon: float
    """s: the last row before an angle is wrong by more than `error`."""
    error: float
    """rad"""
    to_the_end: bool
    """Whether no angle ever is."""
    end_error: float
    """rad, estimated for the last row at which it can be told."""
    growth: float
    """Factor by which a small change of the start grows until the horizon."""
    end_error_at: float = math.nan
    """s: the time of `end_error`."""
    cause: str = ""
    """Why the error cannot be told up to the last row, such as a singular pose; "" where it can."""


class Run(metaclass=Answering):
    """A finished or partial run. `run["q1"]` is a column, `run["q"]`, `run["tip"]` are three of them as (rows, 3).

    Columns are read-only arrays of float64, views of the run's own memory, in SI units and radians; `units` names them.
    """

    def __init__(
        self, columns: Mapping[str, Floats], units: Mapping[str, str], summary: dict[str, Any], report: str | None
    ) -> None:
        """Make a run of data that was stored before; users call `Scenario.run` and `Run.load`."""
        self._columns = dict(columns)
        self.handle = None
        self.units = dict(units)
        self.summary = summary
        self._report = report
        for column in self._columns.values():
            column.flags.writeable = False

    @classmethod
    def of_handle(cls, handle: Any) -> Run:
        """The run that the library holds; handle: its `arm3r_run *`."""
        run = cls.__new__(cls)
        run.handle = handle
        run._columns, run.units = _native.columns(handle)
        run._report = None
        return run

    def __getitem__(self, name: str) -> Floats:
        """A column as (rows,); or three at once, such as "q", "tau_g", "tip", "f_on_tip", as a new (rows, 3).

        Raises:
            ColumnError: there is no such column; the message names the nearest one. It is a KeyError, too.
            TypeError: it is not a name.
        """
        if not isinstance(name, str):
            raise TypeError(f"a column's name is needed, such as run['q1'], got {name!r}; rows are run['q1'][0]")
        if name in self._columns:
            return self._columns[name]
        if parts := three_of(name, self._columns):
            three = np.empty((len(self), 3))
            for i, part in enumerate(parts):
                three[:, i] = self._columns[part]
            return three
        if meant := columns_of(name, _native.column_places()):
            message = f"the log of this run does not have {name!r}: {self._why_not(meant)}"
            raise ColumnError(f"{message}; there are {', '.join(self)}", code="usage")
        raise no_column(name, self._columns)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            is_column = not name.startswith("_") and name in self
            raise no_attribute("Run", name, dir(Run), meant=f"run[{name!r}]" if is_column else "")

    def _why_not(self, meant: list[str]) -> str:
        """Why columns of other runs are none of this one's."""
        if self.has_chosen_columns:
            return f"add {', '.join(meant)} to time.log_columns, or leave that out"
        return "`arm3r columns` says what a run needs for it"

    @property
    def has_chosen_columns(self) -> bool:
        """Whether the scenario chose the columns of the log (`time.log_columns`)."""
        return "log_columns:" in (self.summary.get("scenario") or "")

    def __contains__(self, name: object) -> bool:
        """Whether run[name] is there."""
        return name in self._columns or (isinstance(name, str) and bool(three_of(name, self._columns)))

    def __iter__(self) -> Iterator[str]:
        """The columns' names, in order."""
        return iter(self._columns)

    def __len__(self) -> int:
        """How many rows there are."""
        return len(self.t)

    def keys(self) -> list[str]:
        """The columns' names, in order: dict(run) is a dict of the columns."""
        return self.columns

    def __repr__(self) -> str:
        failed = sum(not check["passed"] for check in self.checks)
        checks = f", {failed} of {len(self.checks)} checks failed" if failed else ""
        return f"<Run {self.summary['name']}: {self.outcome}{checks}, {len(self)} rows to t = {self.t[-1]:g} s>"

    def _repr_html_(self) -> str:
        return str(provided("page of a run")(self))

    def _ipython_key_completions_(self) -> list[str]:
        return completions(self._columns)

    def __reduce__(self) -> tuple[Any, ...]:
        return Run, (self._columns, self.units, self.summary, self._text())

    @property
    def t(self) -> Floats:
        """Time: (rows,), s."""
        return self._columns["t"]

    @property
    def columns(self) -> list[str]:
        """Names of the columns, in order."""
        return list(self._columns)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The summary, as in the JSON file beside a CSV: name, outcome, events, checks, peak_force, hash, ...

        The text "inf", which stands in JSON for a number without end, is `math.inf` here, as it is in a batch.
        """
        return with_numbers(json.loads(_native.text(lib.arm3r_run_summary, self.handle)))

    @property
    def has_report(self) -> bool:
        """Whether there is one: a run that was read from a CSV file has none."""
        return self._text() is not None

    def report(self) -> str:
        """The summary as text that people read.

        Raises:
            UsageError: the run was read from a CSV file, which has none.
        """
        text = self._text()
        if text is None:
            raise UsageError("a run read from a CSV file has no report; its numbers are in summary", code="usage")
        return text

    def _text(self) -> str | None:
        return self._report if self.handle is None else _native.text(lib.arm3r_run_report, self.handle)

    @cached_property
    def outcome(self) -> str:
        """ "ok", "stopped", "diverged", ..."""
        return self.summary["outcome"] if self.handle is None else _native.outcome(self.handle)

    @property
    def events(self) -> list[Event]:
        """Contacts made and broken, in time order."""
        return [
            Event(e["type"], e["t"], tuple(e["q"]), tuple(e["qd"]), tuple(e["tip"])) for e in self.summary["events"]
        ]

    @property
    def closed_forms(self) -> list[ClosedForm]:
        """What theory says of the run's contacts; none where no closed form holds, or says nothing."""
        found = self.summary.get("closed_forms") or {"numbers": []}
        return [
            ClosedForm(one["name"], one["unit"], *(_number(one[key]) for key in ("own", "closed_form", "allowed")))
            for one in found["numbers"]
        ]

    @property
    def trust(self) -> Trust | None:
        """Up to when the run is right; None: it was not run with `trust=True`."""
        found = self.summary.get("trust")
        if not found:
            return None
        horizon, error, end_error, growth = (_number(found[key]) for key in ("horizon", "error", "end_error", "growth"))
        at, cause = _number(found.get("end_error_at")), found.get("cause", "")
        return Trust(horizon, error, bool(found["to_the_end"]), end_error, growth, at, cause)

    @property
    def checks(self) -> list[dict[str, Any]]:
        """The scenario's checks: dicts with the keys name, passed, value and limit."""
        return self.summary["checks"]

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check["passed"] for check in self.checks)

    @property
    def warnings(self) -> list[str]:
        """What is allowed in the scenario but probably a mistake."""
        return self.summary["warnings"]

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write PATH, which ends in .csv, and beside it the summary with the suffix .json: each whole or not at all.

        Raises:
            OutputError: it cannot be written.
            UsageError: the name has another ending; or the run was not made in this process: it has been written
                before, or use `to_npz`.
        """
        if self.handle is None:
            raise UsageError("only a run made in this process is written as CSV; use to_npz", code="usage")
        if os.fspath(path):  # the library has a sentence for an empty name
            check_ending(path, [".csv"], hint="to_npz writes .npz, to_html .html")
        self.save(path)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write PATH, .csv or .npz, and the summary beside it, as `arm3r run -o` does."""
        _native.call(lib.arm3r_run_save, self.handle, *_native.file_path(path))

    def to_npz(self, path: str | os.PathLike[str]) -> None:
        """Write everything into one file, .npz, that `Run.load` and `numpy.load` read: whole or not at all.

        Raises:
            OutputError: it cannot be written.
            UsageError: the name has another ending.
        """
        check_ending(path, [".npz"], hint="to_csv writes .csv, to_html .html")
        write_npz(Path(path), RunData(self._columns, self.units, self.summary, self._text()))

    def to_pandas(self) -> pandas.DataFrame:
        """The columns as a pandas.DataFrame with the time as its index; `attrs["units"]` has their units.

        Raises:
            UsageError: pandas is not installed; it is the extra `pandas`.
        """
        frame: pandas.DataFrame = provided("run to pandas")(self)
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """The columns as an xarray.Dataset over the dimension t; each has its unit in `attrs["units"]`.

        Raises:
            UsageError: xarray is not installed; it is the extra `xarray`.
        """
        dataset: xarray.Dataset = provided("run to xarray")(self)
        return dataset

    def to_html(self, path: str | os.PathLike[str]) -> None:
        """Write the live page with this run into one file that opens from disk, whole or not at all.

        Raises:
            OutputError: it cannot be written.
            UsageError: the name has another ending than .html, the installation has no page, or the run's summary holds
                no scenario.
        """
        provided("live page of a run")(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Run:
        """Read what `to_csv`, `arm3r run -o` (PATH.csv, with PATH.json beside it) or `to_npz` wrote, to the same bits.

        Raises:
            UsageError: a file cannot be read, its suffix is neither .csv nor .npz, or its numbers are not those that
                the summary was written for: their count and their hash are compared.
        """
        return cls(*read(Path(path)))


def _number(value: Any) -> float:
    """A number of the summary: JSON has no NaN, and the library writes null; it writes "inf", too."""
    return float("nan" if value is None else value)
