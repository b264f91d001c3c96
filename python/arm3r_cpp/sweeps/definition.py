"""A sweep: a scenario, axes, and what is kept of every run. The library reads the file by its table of keys."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice, product
from pathlib import Path
from typing import Any

from .. import _native
from .._files import regular
from .._messages import describe, did_you_mean
from ..core.batch import AXIS_ERRORS, axis_of, put, same_places
from ..core.flow import flow as flow_of
from ..core.params import param_key, places
from ..core.scenario import Scenario
from ..errors import Arm3rError, ScenarioError, UsageError
from .axes import SPACES, SweepAxis, values_of
from .shard import Statistic, is_of_arm

FILE = "arm.urdf"
ARM_ERROR = "scenario.arm_file"
MAX_COMBINATIONS_TRIED = 256


class Sweep:
    """A sweep, read from YAML or made from a map of the same keys.

    Attributes:
        text: as it was read.
        scenario: the base, with the file's `set` and the overrides put in.
        axes: what varies, in order; in a grid the last is the fastest.
        mode: "grid", "list", "random" or "latin_hypercube".
        runs: how many.
        seed: of what is random.
        metrics: columns of a run's summary that are kept.
        statistics: numbers made of columns of the run itself.
        shard: runs in one piece of work.
        units: of the table's columns, by name; "" for none.
    """

    def __init__(
        self, source: str | bytes | Mapping[str, Any], *, file: str = "sweep.yaml", overrides: Sequence[str] = ()
    ) -> None:
        """Read a sweep from text, or take a map; `file` is its name in messages, and a scenario's file lies beside it.

        overrides: "PATH=VALUE" each, put into the scenario last.

        Raises:
            ScenarioError: it is not valid; all that is wrong is listed.
            UsageError: a file cannot be read, or the text is the name of one.
        """
        if isinstance(source, str) and os.path.isfile(source):
            raise UsageError(f"source: a file's name instead of a sweep; use Sweep.load({source!r})", code="usage")
        text = flow_of(source, "") if isinstance(source, Mapping) else source
        data = text.encode() if isinstance(text, str) else text
        self.text, self.file = data.decode(errors="replace"), file
        base, given = _native.sweep(data, file)
        self.mode: str = given["mode"]
        self.seed, self.shard = int(given["seed"]), int(given["shard"])
        self.axes = tuple(_axis(**axis) for axis in given["axes"])
        counts = [axis.count or 1 for axis in self.axes]
        self.runs = int(given.get("runs") or (math.prod(counts) if self.mode == "grid" else counts[0]))
        known = list(_native.summary_columns())
        self.metrics = [name for name in given.get("metrics", known) if name != "outcome"]
        self.statistics = [Statistic(one["column"], one["of"]) for one in given.get("statistics", [])]
        self.scenario = Scenario.of_handle(base, given["scenario"])
        for override in overrides:
            self.scenario.set_from_option(override)
        self.scenario.validate()
        self.scenario.quiet()
        columns = _columns(self.scenario)
        _check(self, given, list(columns))
        self.units = {statistic.name: columns[statistic.column] for statistic in self.statistics}
        self.units |= {name: unit.removeprefix("1") for name, unit in _native.summary_columns().items()}
        self.units |= {name: param_key(indices[0]).unit for name, indices in places().items()}

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, overrides: Sequence[str] = ()) -> Sweep:
        """Read a sweep from a file. Raises as for a text."""
        try:
            data = regular(Path(path)).read_bytes()
        except OSError as error:
            raise UsageError(f"{os.fspath(path)}: cannot be read: {error.strerror}", code="file") from error
        return cls(data, file=os.fspath(path), overrides=overrides)

    def __repr__(self) -> str:
        return f"<Sweep {self.file}: {self.runs} runs over {', '.join(axis.key for axis in self.axes)}>"

    def values(self, first: int = 0, count: int | None = None) -> dict[str, Any]:
        """The values of every axis in `count` runs from run `first`: arrays by key, a row a run."""
        count = self.runs - first if count is None else count
        return values_of(self.axes, self.mode, self.seed, self.runs, first, count)

    def arms(self) -> dict[tuple[str, ...], Scenario]:
        """The scenario with each arm, by the values of the axes that tell it; empty where none does.

        An arm's file lies beside that of the sweep.
        """
        axes = [axis for axis in self.axes if is_of_arm(axis.key)]
        combine = zip if self.mode == "list" else product
        found = {}
        for words in combine(*(axis.items for axis in axes)) if axes else ():
            found[words] = scenario = self.scenario.copy()
            scenario["checks"] = []
            for axis, word in zip(axes, words, strict=True):
                put(scenario, axis.key, str(Path(self.file).parent.absolute() / word) if axis.key == FILE else word)
        return found


def _axis(key: str, at: str, **values: list[Any]) -> SweepAxis:
    """An axis as the library read it."""
    ((rule, items),) = values.items()
    read = tuple(_item(item) for item in items)
    read = (*read[:2], int(read[2])) if rule in SPACES else read
    return SweepAxis(key, rule, read, param_key(places()[key][0]).unit)


def _item(value: Any) -> Any:
    """A value of an axis: JSON has no infinity, and one kind of numbers."""
    if isinstance(value, list):
        return [_item(item) for item in value]
    return value if isinstance(value, bool) or (isinstance(value, str) and value != "inf") else float(value)


def _columns(scenario: Scenario) -> dict[str, str]:
    """The units of the columns that its runs have: those of the shortest."""
    short = scenario.copy()
    short["checks"], short["time.stop"] = [], short["time.start"]
    return short.run().units


def _check(sweep: Sweep, given: dict[str, Any], columns: list[str]) -> None:
    """Check that the scenario has the columns of statistics, and the keys of axes with every combination of words."""
    problems: list[dict[str, Any]] = []

    def note(at: str, code: str, path: str, message: str, *, got: str = "", allowed: str = "", hint: str = "") -> None:
        line, column = map(int, at.split(":"))
        place = {"file": sweep.file, "line": line, "column": column, "path": path}
        problems.append({"code": code, "message": message, **place, "got": got, "allowed": allowed, "hint": hint})

    def finish() -> None:
        if problems:
            raise ScenarioError("\n".join(map(describe, problems)), code=problems[0]["code"], problems=problems)

    for i, one in enumerate(given.get("statistics", [])):
        if (column := one["column"]) not in columns:
            note(one["at"], "sweep.unknown_word", f"statistics[{i}].column", "the run has no such column",
                 got=column, allowed=", ".join(columns), hint=did_you_mean(column, columns))  # fmt: skip
    axes = [(axis, one["at"]) for axis, one in zip(sweep.axes, given["axes"], strict=True)]
    first = sweep.values(0, 1)
    for i, (axis, at) in enumerate(axes):
        for other, _ in axes[:i]:
            if twice := same_places(axis.key, other.key):
                both = f"{twice[0]} varies twice, as {other.key} and as {axis.key}"
                note(at, "sweep.duplicate", f"axes[{i}].key", both, hint="take one of the two out")
        try:
            shape = axis_of(sweep.scenario, axis.key, first[axis.key]).values.shape
            if len(shape) > 2:
                note(at, "sweep.axis", axis.key, "in the scenario this is one number",
                     got=f"a list of {shape[1]}", hint="`set` it to a list there too")  # fmt: skip
        except (Arm3rError, TypeError, ValueError) as error:
            note(at, "sweep.axis", axis.key, str(error).removeprefix(f"{axis.key}: "))
    finish()
    for scenario in islice(_combinations(sweep, first), MAX_COMBINATIONS_TRIED):
        try:
            scenario.validate()
        except ScenarioError as error:
            for found in error.problems:
                if found["code"] in (*AXIS_ERRORS, ARM_ERROR):
                    at = next((at for axis, at in axes if _same(axis.key, found["path"])), axes[0][1])
                    note(at, **{name: found[name] for name in ("code", "path", "message", "got", "allowed", "hint")})
        finish()


def _combinations(sweep: Sweep, first: dict[str, Any]) -> Iterator[Scenario]:
    """The scenario with every combination of words and flags, and the first of all numbers."""
    words = [axis for axis in sweep.axes if axis.rule == "values" and isinstance(axis.items[0], (str, bool))]
    numbers = {axis.key: first[axis.key][0] for axis in sweep.axes if axis not in words}
    words = [axis for axis in words if not is_of_arm(axis.key)]
    for base, *chosen in product(sweep.arms().values() or [sweep.scenario], *(axis.items for axis in words)):
        scenario = base.copy()
        scenario["checks"] = []
        for key, value in [*zip((axis.key for axis in words), chosen, strict=True), *numbers.items()]:
            scenario[key] = int(value) if param_key(places()[key][0]).kind == "integer" else value
        yield scenario


def _same(key: str, path: str) -> bool:
    return key.split("[")[0] == path.split("[")[0]
