"""Many runs through one call: a scenario, arrays in the places of some of its values, and a table of summaries."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from .. import _native
from .._messages import no_column
from .._native import BatchProgress, Floats, Progress, lib
from ..answers.refusals import Refusal, lines_of, refusals_of
from ..control.batch_law import BatchLaw, MakeLaw
from ..control.law import Law, NativeLaw
from ..errors import BudgetError, ColumnError, ScenarioError, UsageError
from ..rows.batch_rows import BatchRows
from ..rows.names import columns_asked_for, metrics_asked_for
from .advice import Advice
from .flow import flow
from .params import param_index, param_key, param_name, places
from .protocols import AnyScenario, LawOfFile
from .provided import provided
from .run import Run

if TYPE_CHECKING:
    import pandas
    import xarray

Index = int | tuple[int, ...]
S = TypeVar("S", bound=AnyScenario)

# Codes of errors of the axes themselves, which no other number in a run would avoid.
AXIS_ERRORS = {f"scenario.{error}" for error in ("unknown_word", "type", "unknown_key", "other_choice", "missing_key")}
AXIS_ERRORS.add("number.syntax")


MOST_REFUSED = 10_000  # runs whose reasons are looked for: each is read as a scenario of its own


class Axis(NamedTuple):
    """The values of one key."""

    key: str
    indices: list[int]
    """of its numbers among all of a scenario; none for words and flags"""
    values: NDArray[Any]
    """(..., numbers), float64; of words and flags (..., 1)"""

    @property
    def names(self) -> list[str]:
        """Of its numbers: "initial.q[0]", "initial.q[1]", ...; else its key."""
        return [param_name(index) for index in self.indices] if len(self.indices) > 1 else [self.key]

    @property
    def unit(self) -> str:
        """Of its numbers; "" for none, and for words and flags."""
        return param_key(self.indices[0]).unit if self.indices else ""

    def at(self, place: tuple[int, ...], shape: tuple[int, ...]) -> Any:
        """Its value in one run, as `Scenario` takes it."""
        value = np.broadcast_to(self.values, (*shape, self.values.shape[-1]))[place].tolist()
        if self.indices and param_key(self.indices[0]).kind == "integer":
            value = [int(number) if number.is_integer() else number for number in value]
        return value if len(value) > 1 else value[0]


class Batch(Generic[S]):
    """A table of runs: `batch["peak_force"]` is a column, in the shape that the axes broadcast to.

    Columns are read-only arrays of float64 in SI units and radians, NaN where a run has no such number. Each has the
    bits of the summary of that run alone.

    Attributes:
        axes: the values by key, in shapes that broadcast to `shape`; of a key with several numbers with these last.
        shape: of every column.
        names: of the columns, in order.
        units: of the columns, by name; "1" for none.
    """

    def __init__(
        self,
        scenario: S,
        axes: list[Axis],
        columns: Mapping[str, Floats],
        shape: tuple[int, ...],
        law: BatchLaw | None = None,
        rows: BatchRows | None = None,
    ) -> None:
        """`Scenario.batch` makes batches."""
        self._scenario, self.varied, self._columns, self._law = scenario, axes, dict(columns), law
        self._rows = rows
        self.axes = {axis.key: axis.values if axis.values.shape[-1] > 1 else axis.values[..., 0] for axis in axes}
        self.shape = shape
        self.names = list(columns)
        self.units = {name: unit for name, unit in _native.summary_columns().items() if name in columns}
        for array in (*columns.values(), *self.axes.values()):
            array.flags.writeable = False

    def __reduce__(self) -> tuple[Any, ...]:
        return Batch, (self._scenario, self.varied, self._columns, self.shape, None, self._rows)

    def __getitem__(self, name: str) -> Floats:
        """A column.

        Raises:
            KeyError: there is no such column, and the message names the nearest one; or it was not asked for.
        """
        if name in self._columns:
            return self._columns[name]
        if name in _native.summary_columns():
            raise ColumnError(f"no column {name!r}: this batch was asked for others; name it in metrics", code="usage")
        raise no_column(name, self.names)

    def __iter__(self) -> Iterator[str]:
        """The columns' names, in order."""
        return iter(self._columns)

    def keys(self) -> list[str]:
        """The columns' names, in order: dict(batch) is a dict of the columns."""
        return list(self._columns)

    def _ipython_key_completions_(self) -> list[str]:
        return self.keys()

    def __len__(self) -> int:
        """How many runs there are."""
        return math.prod(self.shape)

    def __repr__(self) -> str:
        over = ", ".join(self.axes) or "nothing"
        return f"<Batch of {len(self)} runs over {over}: {np.count_nonzero(self.ok)} ok>"

    def _repr_html_(self) -> str:
        return str(provided("page of a batch")(self))

    def to_pandas(self) -> pandas.DataFrame:
        """A pandas.DataFrame with a row for each run: the values that vary, the outcome in words, the other columns.

        The rows of a batch of several dimensions have the order of `batch["peak_force"].ravel()`.

        Raises:
            UsageError: pandas is not installed; it is the extra `pandas`.
        """
        frame: pandas.DataFrame = provided("batch to pandas")(self)
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """An xarray.Dataset of the columns in the batch's shape; the outcome is in words.

        The values that vary are coordinates. A dimension along which one key varies has its name; any other is called
        "run" or, where there are several, "axis_0", "axis_1".

        Raises:
            UsageError: xarray is not installed; it is the extra `xarray`.
        """
        dataset: xarray.Dataset = provided("batch to xarray")(self)
        return dataset

    @property
    def rows(self) -> BatchRows:
        """The columns over time that the batch was asked for, of all its runs.

        Raises:
            UsageError: it was not asked for any.
        """
        if self._rows is None:
            raise UsageError('this batch has no rows; ask for them: scenario.batch(..., columns=["q1"])', code="usage")
        return self._rows

    @property
    def outcomes(self) -> NDArray[np.str_]:
        """How every run ended, in words: "ok", "diverged", ..., "invalid" where its numbers are not valid."""
        numbers, which = np.unique(self["outcome"], return_inverse=True)
        words = np.array([_native.outcome_name(int(number)) for number in numbers], np.str_)
        return words[which].reshape(self.shape)

    @property
    def ok(self) -> NDArray[np.bool_]:
        """Which runs reached their end."""
        return self["outcome"] == lib.ARM3R_RUN_OK

    def refusals(self, *, most: int = MOST_REFUSED) -> list[Refusal]:
        """Why runs have the outcome `invalid`: each reason with how often it holds and a message, the most frequent
        first.

        most: how many of these runs are asked, the first ones.
        """
        invalid = np.argwhere(self["outcome"] == lib.ARM3R_RUN_INVALID)[:most]
        return refusals_of(self.scenario(tuple(map(int, place))).quiet() for place in invalid)

    def scenario(self, index: Index) -> S:
        """The scenario of one run, without checks: those of the base were not meant for it.

        index: of one run, as for a column.
        """
        place = index if isinstance(index, tuple) else (index,)
        if len(place) != len(self.shape):
            raise IndexError(f"index {index}: one run of a batch of shape {self.shape} has {len(self.shape)} of them")
        if not all(hasattr(i, "__index__") and not isinstance(i, (bool, np.bool_)) for i in place):
            raise IndexError(f"index {index}: whole numbers tell one run of a batch of shape {self.shape}")
        return _scenario(self._scenario, self.varied, place, self.shape)

    def run(self, index: Index, *, progress: Progress | None = None) -> Run:
        """One run alone, with all its rows and the same bits. Raises as `Scenario.run`.

        A law of your own is asked again. A batch that was pickled has none any more: use `scenario(index).run`.

        index: of one run, as for a column.
        progress: as of `Scenario.run`.
        """
        law = self._law.of_run(index) if self._law else None
        return self.scenario(index).run(controller=law, progress=progress)


def run_batch(
    scenario: S,
    values: Mapping[str, Any],
    *,
    grid: bool = False,
    threads: int | None = None,
    progress: BatchProgress | None = None,
    controller: Law | NativeLaw | LawOfFile | str | os.PathLike[str] | None = None,
    make_controller: MakeLaw | None = None,
    rate: float | None = None,
    columns: Sequence[str] | None = None,
    metrics: Sequence[str] | None = None,
) -> Batch[S]:
    """What `Scenario.batch` does."""
    has_law = controller is not None or make_controller is not None
    _check_options(values, threads, rate, has_law)
    asked = [] if columns is None else columns_asked_for(columns)
    names = metrics_asked_for(metrics)
    mine = scenario.for_law(rate) if has_law else scenario
    mine.validate()
    base = mine.copy()
    base["checks"] = []
    axes = _axes_of(base, values)
    axes = _crossed(axes) if grid else axes
    shape = _shape(axes)
    runs = math.prod(shape)
    varied = [index for axis in axes for index in axis.indices]
    law: Any = controller
    if make_controller is None and (block := _block_of(controller)):
        law, make_controller = None, _law_of_row(block, base, axes, shape)
    law = BatchLaw(law, make_controller, shape, scenario.file) if has_law else None
    _check_room(runs, len(varied) + len(names))
    numbers = _numbers(axes, shape)
    groups = [
        _Group(group, _params(base, axes, shape, group), np.ascontiguousarray(numbers[:, group]))
        for group in (law.groups(_groups(axes, shape)) if law else _groups(axes, shape))
    ]
    memory = _room_for_rows(runs, asked, _most_rows(groups, varied, asked) or _rows_of(base, asked))
    table = _Work(base, names, asked, varied, runs, law, threads, progress).table(groups, memory)
    summaries = {name: column.reshape(shape) for name, column in zip(names, table, strict=True)}
    batch = Batch(base, axes, summaries, shape, law, BatchRows(asked, memory, shape) if asked else None)
    if not base.is_quiet and runs and (batch["outcome"] == lib.ARM3R_RUN_INVALID).all():
        base.warn([f"no run of this batch is valid: {'; '.join(lines_of(batch.refusals(), runs))}"])
    return batch


def _check_options(values: Any, threads: Any, rate: float | None, has_law: bool) -> None:
    if not isinstance(values, Mapping):
        raise TypeError(f"values: a map of arrays by key is needed, got {type(values).__name__}")
    if threads is not None and not (hasattr(threads, "__index__") and 1 <= threads < 2**31):
        raise UsageError(f"threads: a whole number from 1 is needed, got {threads!r}", code="usage")
    if rate is not None and not has_law:
        raise UsageError("rate: it is that of a controller, and none is given; set sampling.rate", code="usage")


def _axes_of(base: AnyScenario, values: Mapping[str, Any]) -> list[Axis]:
    """UsageError: a number varies twice."""
    axes = [axis_of(base, key, value) for key, value in values.items()]
    for key, other in combinations(values, 2):
        if twice := same_places(key, other):
            raise UsageError(f"{twice[0]} varies twice, as {key} and as {other}; take one of them out", code="usage")
    return axes


class _Group(NamedTuple):
    """Runs that are one call of the library."""

    runs: Any
    """their numbers, as an array or a slice"""
    params: Floats | None
    """of any valid one of them; None: there is none"""
    values: Floats
    """(varied, runs)"""


@dataclass
class _Work:
    """What the library computes of every group of runs, and how it is watched."""

    base: AnyScenario
    names: list[str]
    """of the table's columns"""
    asked: list[str]
    """columns over time"""
    varied: list[int]
    """indices of the numbers that vary"""
    runs: int
    law: BatchLaw | None
    threads: int | None
    progress: BatchProgress | None
    done: int = 0
    """runs of the groups before"""

    def __post_init__(self) -> None:
        self._advice = None if self.law or self.base.is_quiet else Advice(self.base)

    def table(self, groups: Sequence[_Group], memory: Floats) -> Floats:
        """The table (names, runs); the rows of the runs go into `memory`."""
        if len(groups) == 1:
            return self._of(groups[0], memory)
        table = np.empty((len(self.names), self.runs))
        for group in groups:
            rows = memory[group.runs]
            table[:, group.runs] = self._of(group, rows)
            memory[group.runs] = rows
            self.done += len(group.runs)
        return table

    def _of(self, group: _Group, rows: Floats) -> Floats:
        if group.params is None:
            rows.fill(np.nan)
            table = np.full((len(self.names), group.values.shape[1]), np.nan)
            table[self.names.index("outcome")] = lib.ARM3R_RUN_INVALID
            return table
        given = group.params, self.varied, group.values
        wanted = {"rows": (self.asked, rows) if self.asked else None, "metrics": self.names}
        options: Any = {"threads": self.threads, "progress": self._report, **wanted}
        return self.law.table(group.runs, *given, **options) if self.law else _native.batch(*given, **options)[0]

    def _report(self, runs_done: int, _: int) -> Any:
        done = self.done + runs_done
        if self._advice and (sentence := self._advice.after(done, self.runs)):
            self.base.warn([sentence])
        return self.progress and self.progress(done, self.runs)


def _block_of(controller: Any) -> LawOfFile | None:
    """The function in a file that is given as a law; None: it is a law already, or nothing that can be one."""
    if controller is None or callable(controller) or isinstance(controller, NativeLaw):
        return None
    block = provided("function of a file")(controller) if isinstance(controller, (str, os.PathLike)) else controller
    return block if isinstance(block, LawOfFile) else None


def _law_of_row(block: LawOfFile, base: AnyScenario, axes: Sequence[Axis], shape: tuple[int, ...]) -> MakeLaw:
    """Makes the law of a run for the arm of that run. A file that cannot be executed raises at once."""
    block.law(base)
    return lambda index: block.law(_scenario(base, axes, index if isinstance(index, tuple) else (index,), shape))


# ---- axes -----------------------------------------------------------------------------------------------------------


def axis_of(base: AnyScenario, key: str, value: Any) -> Axis:
    """What `value` means for a key. UsageError: there is no such key, or its shape does not fit."""
    if key not in places():
        param_index(key)  # raises, and names the nearest one
    indices = places()[key]
    kind = param_key(indices[0]).kind
    if kind == "section":
        raise UsageError(f"{key}: a section cannot vary; name a key in it, such as {_below(key)}", code="usage")
    if kind == "column":
        raise UsageError(f"{key}: it chooses columns of a log; `columns` chooses those of a batch", code="usage")
    try:
        array = np.asarray(_words_of_joints(key, value) if key in OF_JOINTS else value)
    except ValueError as error:
        raise UsageError(f"{key}: its values do not have one shape: {error}", code="usage") from error
    if array.dtype.kind == "U" or (array.dtype.kind == "b" and kind == "flag"):
        return Axis(key, [], array[..., np.newaxis])
    if kind in _WORDS:
        raise UsageError(f"{key}: {_WORDS[kind]} are needed, got an array of {array.dtype}", code="usage")
    array = _native.reals(value, key)
    if np.isnan(array).any():
        place = "".join(f"[{i}]" for i in np.argwhere(np.isnan(array))[0])
        raise UsageError(f"{key}: {key}{place} is nan; a key that is to keep its default is left out", code="usage")
    width = _width(base, key, indices, array)
    if width == 1:
        return Axis(key, indices[:1], array[..., np.newaxis] + 0.0)
    if array.shape[-1:] != (width,):
        fix = f"one of its numbers alone is {key}[0]"
        raise UsageError(f"{key}: the shape (..., {width}) is needed, got {array.shape}; {fix}", code="usage")
    return Axis(key, indices, array + 0.0)


OF_JOINTS = ("arm.joints", "arm.lock")
"""Keys that take lists or maps of words: as values of an axis they are YAML, "[pan, lift, elbow]"."""


def _words_of_joints(key: str, value: Any) -> Any:
    """The values of an axis over joints, each as YAML."""
    if isinstance(value, Mapping):
        return flow(value, key)
    if not isinstance(value, (list, tuple)):
        return value
    is_names = key == "arm.joints" and all(isinstance(one, str) and not one.startswith("[") for one in value)
    return flow(value, key) if value and is_names else [_words_of_joints(key, one) for one in value]


def put(scenario: AnyScenario, key: str, value: Any) -> None:
    """Put a value of an axis."""
    if key in OF_JOINTS:
        scenario.edit(key, value, key)
    else:
        scenario[key] = value


_WORDS = {"choice": "words", "flag": "true or false", "file": "names of files", "arm_file": "words"}


def same_places(key: str, other: str) -> list[str]:
    """The numbers that two keys have in common, by name: "initial.q" and "initial.q[1]" have the latter."""
    return [param_name(index) for index in places()[key] if index in places()[other]]


def _below(key: str) -> str:
    return next(place for place in places() if place.startswith(f"{key}."))


def _width(base: AnyScenario, key: str, indices: list[int], array: NDArray[Any]) -> int:
    """How many numbers of the key stand together: of one that takes a number or a list, as many as in the base."""
    if len(indices) == 1:
        return 1
    now = base[key]
    if now is None:
        return len(indices) if array.shape[-1:] == (len(indices),) else 1
    return 1 if isinstance(now, (int, float)) else len(indices)


def _crossed(axes: Sequence[Axis]) -> list[Axis]:
    """Every axis with dimensions of its own."""
    crossed, behind = [], sum(axis.values.ndim - 1 for axis in axes)
    for axis in axes:
        own = axis.values.shape[:-1]
        behind -= len(own)
        crossed.append(axis._replace(values=axis.values.reshape(*own, *[1] * behind, axis.values.shape[-1])))
    return crossed


def _shape(axes: Sequence[Axis]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(*(axis.values.shape[:-1] for axis in axes))
    except ValueError:
        shapes = ", ".join(f"{axis.key} {axis.values.shape[:-1]}" for axis in axes)
        raise UsageError(f"the axes do not broadcast: {shapes}; grid=True crosses them", code="usage") from None


def _check_room(runs: int, numbers: int) -> None:
    try:
        np.empty((numbers, runs))
    except (MemoryError, ValueError) as error:
        what = f"{runs} runs are a table of {8e-9 * numbers * runs:.3g} GB"
        raise _no_room(f"{what}, more than there is memory; a sweep keeps it in a folder") from error


def _no_room(message: str) -> BudgetError:
    return BudgetError(message, code="budget.memory")


# ---- rows -----------------------------------------------------------------------------------------------------------


def _most_rows(groups: Sequence[_Group], varied: list[int], columns: Sequence[str]) -> int:
    """The most rows of any run. ScenarioError: no run of any group has one of the columns."""
    counts, refusals = [0], []
    valid = [(group.params, varied, group.values) for group in groups if group.params is not None] if columns else []
    for given in valid:
        try:
            counts.append(_native.batch_row_count(*given, columns))
        except ScenarioError as error:
            refusals.append(error)
            there = [name for name in columns if name not in _missing(error)]
            counts.append(_native.batch_row_count(*given, there))
    if refusals and len(refusals) == len(valid) and set.intersection(*map(_missing, refusals)):
        raise min(refusals, key=lambda error: len(error.problems))
    return max(counts)


def _rows_of(base: AnyScenario, columns: Sequence[str]) -> int:
    """The rows of the scenario itself: where no run of a batch is valid, theirs would be as many."""
    return _native.batch_row_count(base.params, [], np.empty((0, 1)), ["t"]) if columns else 0


def _missing(error: ScenarioError) -> set[str]:
    """The columns that no run of a group has."""
    return {problem["got"] for problem in error.problems}


def _room_for_rows(runs: int, columns: Sequence[str], rows: int) -> Floats:
    """Memory for the rows of all runs: (runs, columns, rows). BudgetError: there is not so much."""
    try:
        return np.empty((runs, len(columns), rows))
    except (MemoryError, ValueError) as error:
        size = f"{len(columns)} columns of {rows} rows for {runs} runs are {8e-9 * runs * len(columns) * rows:.3g} GB"
        raise _no_room(
            f"{size}, more than there is memory; choose fewer columns, a longer time.log_every, or fewer runs at a time"
        ) from error


def _numbers(axes: Sequence[Axis], shape: tuple[int, ...]) -> Floats:
    """What the library varies: a row a number, a column a run."""
    numbers = np.empty((sum(len(axis.indices) for axis in axes), math.prod(shape)))
    rows = iter(numbers)
    for axis in axes:
        for i, row in zip(range(len(axis.indices)), rows, strict=False):
            row.reshape(shape)[...] = axis.values[..., i]
    return numbers


# ---- words ----------------------------------------------------------------------------------------------------------


def _groups(axes: Sequence[Axis], shape: tuple[int, ...]) -> list[Any]:
    """The runs that have all their words and flags in common: each group is a call of the library."""
    words = [axis.values[..., 0] for axis in axes if not axis.indices]
    if not words:
        return [slice(None)]
    label = np.zeros(shape, np.intp)
    for values in words:
        known, which = np.unique(values, return_inverse=True)
        label = label * len(known) + which.reshape(values.shape)
    return [np.flatnonzero(label == number) for number in np.unique(label)]


def _scenario(base: S, axes: Sequence[Axis], place: tuple[int, ...], shape: tuple[int, ...]) -> S:
    scenario = base.copy()
    for axis in sorted(axes, key=lambda axis: bool(axis.indices)):  # words first: keys exist only under some
        put(scenario, axis.key, axis.at(place, shape))
    return scenario


def _params(base: AnyScenario, axes: Sequence[Axis], shape: tuple[int, ...], group: Any) -> Floats | None:
    """The numbers of any valid run of a group; the varied ones do not matter. None: no run of it is valid."""
    if isinstance(group, slice) and all(axis.key in base for axis in axes):
        return base.params
    for run in np.arange(math.prod(shape))[group]:
        place = tuple(int(i) for i in np.unravel_index(run, shape))
        try:
            return _scenario(base, axes, place, shape).params
        except ScenarioError as error:
            if any(problem["code"] in AXIS_ERRORS for problem in error.problems):
                raise
    return None
