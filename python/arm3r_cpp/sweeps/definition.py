"""A sweep: a scenario, axes, and what is kept of every run. Read from YAML by the library's own strict reader."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice, product
from pathlib import Path
from typing import Any

from .. import _native
from .._files import regular
from ..core.batch import AXIS_ERRORS, axis_of
from ..core.params import param_key, places
from ..core.scenario import Scenario
from ..core.scenario import flow as flow_of
from ..errors import Arm3rError, IncompatibleError, ScenarioError, UsageError
from .axes import MODES, SweepAxis, values_of
from .axis_reader import MAX_RUNS, read_axes
from .shard import STATISTICS, Statistic, is_of_arm
from .yaml_reader import Node, Reader, below, flow, position, quoted

FORMAT = 1
FILE = "arm.urdf"
ARM_ERROR = "scenario.arm_file"
MAX_COMBINATIONS_TRIED = 256
KEYS = {
    "format": "Version of this format.",
    "scenario": "A scenario's file, looked for beside this one, or a scenario as a map.",
    "set": "Values by path, which are put into the scenario.",
    "axes": "What varies: a key of the scenario each, and a rule for its values.",
    "mode": "grid: every combination, the last axis the fastest; list: all axes together; the others draw.",
    "runs": "How many runs are drawn; only in the modes random and latin_hypercube, which need it.",
    "seed": "Seed of what is drawn.",
    "metrics": "Columns of the summary that are kept, besides the outcome; default: all.",
    "statistics": "Numbers made of columns of the run itself, which is then simulated once more.",
    "shard": "Runs in one piece of work, which a worker holds in memory.",
}
DEFAULT_SEED = 1
DEFAULT_SHARD, MAX_SHARD = 1000, 10**6


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
        reader = Reader(file)
        top = reader.map(_native.yaml(data, file), "", KEYS)
        _read_format(reader, top)
        self.shard: int = _whole(reader, top, "shard", DEFAULT_SHARD, 1, MAX_SHARD)
        self.seed: int = _whole(reader, top, "seed", DEFAULT_SEED, 0, 2**53 - 1)
        self.mode: str = (reader.word(top["mode"], "mode", MODES) if "mode" in top else None) or MODES[0]
        self.metrics = _read_metrics(reader, top)
        self.axes = read_axes(reader, top, self.mode)
        self.runs = _read_runs(reader, top, self.mode, self.axes)
        reader.finish()
        self.scenario = _read_scenario(reader, top, overrides)
        columns = _columns(self.scenario)
        self.statistics = _read_statistics(reader, top, list(columns))
        _check_axes(reader, top, self)
        reader.finish()
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
                scenario[axis.key] = str(Path(self.file).parent.absolute() / word) if axis.key == FILE else word
        return found


# ---- the file's keys ------------------------------------------------------------------------------------------------


def _read_format(reader: Reader, top: dict[str, Node]) -> None:
    if "format" not in top:
        start = {"line": 1, "column": 1}
        reader.problem(start, "sweep.format", "format", "the version of the format is missing", hint="write format: 1")
        return
    found = reader.whole(top["format"], "format", 1, 2**53 - 1)
    if found is not None and found != FORMAT:
        message = f"error[sweep.format]: format: must be {FORMAT}, got {found}: it is written for another version"
        raise IncompatibleError(f"{reader.place(top['format'])}: {message}", code="sweep.format")


def _whole(reader: Reader, top: dict[str, Node], key: str, default: int, low: int, high: int) -> int:
    found = reader.whole(top[key], key, low, high) if key in top else default
    return default if found is None else found


def _read_metrics(reader: Reader, top: dict[str, Node]) -> list[str]:
    known = [name for name in _native.summary_columns() if name != "outcome"]
    if "metrics" not in top:
        return known
    nodes = reader.list(top["metrics"], "metrics")
    words = [reader.word(node, f"metrics[{i}]", ["outcome", *known]) for i, node in enumerate(nodes)]
    for i, (node, word) in enumerate(zip(nodes, words, strict=True)):
        if word is not None and word in words[:i]:
            reader.problem(node, "sweep.duplicate", f"metrics[{i}]", "stands here twice", got=word)
    return [word for word in words if word not in (None, "outcome")]


def _read_runs(reader: Reader, top: dict[str, Node], mode: str, axes: Sequence[SweepAxis]) -> int:
    drawn = mode in ("random", "latin_hypercube")
    counts = [axis.count or 1 for axis in axes]
    if drawn and "runs" not in top:
        reader.problem(top.get("mode", top["axes"]), "sweep.missing_key", "runs", f"mode {mode} needs `runs`")
    elif drawn:
        return _whole(reader, top, "runs", 1, 1, MAX_RUNS)
    elif "runs" in top:
        reader.problem(top["runs"], "sweep.runs", "runs", f"in mode {mode} the axes say how many; take it out")
    if mode == "list" and len(set(counts)) > 1:
        lengths = ", ".join(f"{axis.key} {count}" for axis, count in zip(axes, counts, strict=True))
        reader.problem(top["axes"], "sweep.length", "axes", "in mode list all have one length", got=lengths)
    if mode == "grid" and math.prod(counts) > MAX_RUNS:
        steps = " x ".join(map(str, counts))
        reader.problem(top["axes"], "sweep.size", "axes", f"too many combinations: {steps} = {math.prod(counts)}",
                       allowed=f"at most {MAX_RUNS}", hint="use mode random or latin_hypercube")  # fmt: skip
    return math.prod(counts) if mode == "grid" else counts[0] if counts else 0


def _read_statistics(reader: Reader, top: dict[str, Node], columns: list[str]) -> list[Statistic]:
    found: list[Statistic] = []
    for i, node in enumerate(reader.list(top["statistics"], "statistics") if "statistics" in top else []):
        path = f"statistics[{i}]"
        given = reader.map(node, path, Statistic._fields)
        missing = [key for key in Statistic._fields if key not in given]
        if missing:
            reader.problem(node, "sweep.missing_key", path, f"`{missing[0]}` is missing", hint=_EXAMPLE_STATISTIC)
            continue
        column = reader.word(given["column"], below(path, "column"), columns)
        of = reader.word(given["of"], below(path, "of"), STATISTICS)
        if column and of:
            found.append(Statistic(column, of))
            if found.index(found[-1]) < len(found) - 1:
                reader.problem(node, "sweep.duplicate", path, "stands here twice", got=found[-1].name)
    return found


_EXAMPLE_STATISTIC = "such as {column: depth, of: max}"


def _columns(scenario: Scenario) -> dict[str, str]:
    """The units of the columns that its runs have: those of the shortest."""
    short = scenario.copy()
    short["checks"], short["time.stop"] = [], short["time.start"]
    return short.run().units


# ---- the scenario ---------------------------------------------------------------------------------------------------


def _read_scenario(reader: Reader, top: dict[str, Node], overrides: Sequence[str]) -> Scenario:
    try:
        scenario = _base(reader, top)
        for node in top.get("set", {}).get("map", []):
            scenario._edit(node["key"], flow(node), f"{reader.place(node)}: set")
        for override in overrides:
            scenario._set_from_option(override)
        scenario.validate()
        return scenario._quiet()
    except ScenarioError as error:
        inline = top["scenario"] if "map" in top.get("scenario", {}) else None
        found = [_placed(reader, problem, inline) for problem in error.problems]
        reader.problems += [problem for problem in found if problem not in reader.problems]
        reader.finish()
        raise


def _base(reader: Reader, top: dict[str, Node]) -> Scenario:
    """The scenario that the file names or holds; the lecture's arm where it says nothing."""
    if "set" in top:
        reader.map(top["set"], "set")
    node = top.get("scenario")
    if node is None:
        reader.problem({"line": 1, "column": 1}, "sweep.missing_key", "scenario", "the scenario is missing",
                       hint="write scenario: FILE, or the scenario itself below it")  # fmt: skip
    elif "map" in node:
        text = "".join(f"{quoted(child['key'])}: {flow(child)}\n" for child in node["map"])
        return Scenario(text if "format" in [child["key"] for child in node["map"]] else f"format: 1\n{text}",
                        file=reader.file)  # fmt: skip
    elif (name := reader.word(node, "scenario")) is not None:
        path = Path(reader.file).parent / name
        try:
            return Scenario.load(path)
        except UsageError as error:
            reader.problem(node, "sweep.file", "scenario", "cannot be read", got=name, hint=f"there is no {path}"
                           if not path.exists() else str(error))  # fmt: skip
    reader.finish()
    return Scenario()


def _placed(reader: Reader, problem: dict[str, Any], inline: Node | None) -> dict[str, Any]:
    """A problem of a scenario that stands in the sweep's file, with the place where it stands there."""
    if inline is None or problem["file"] != reader.file:
        return problem
    here, path = inline, f".{problem['path']}"
    for child in _walk(inline, path):
        here = child
    line, column = position(here)
    return {**problem, "line": line, "column": column}


def _walk(node: Node, path: str) -> Iterator[Node]:
    """The nodes along a path, as far as there are any."""
    while path and "map" in node:
        key = path[1:].replace("[", ".").split(".")[0]
        found = next((child for child in node["map"] if child["key"] == key), None)
        if found is None:
            return
        node, path = found, path[1 + len(key) :]
        yield node


# ---- axes in the scenario -------------------------------------------------------------------------------------------


def _check_axes(reader: Reader, top: dict[str, Node], sweep: Sweep) -> None:
    """Check that the scenario has the key of every axis, with every combination of words."""
    nodes = {axis.key: node for axis, node in zip(sweep.axes, top["axes"]["list"], strict=True)}
    first = sweep.values(0, 1)
    for axis in sweep.axes:
        try:
            shape = axis_of(sweep.scenario, axis.key, first[axis.key]).values.shape
            if len(shape) > 2:
                reader.problem(nodes[axis.key], "sweep.axis", axis.key, "in the scenario this is one number",
                               got=f"a list of {shape[1]}", hint="`set` it to a list there too")  # fmt: skip
        except (Arm3rError, TypeError, ValueError) as error:
            reader.problem(nodes[axis.key], "sweep.axis", axis.key, str(error).removeprefix(f"{axis.key}: "))
    if reader.problems:
        return
    for scenario in islice(_combinations(sweep, first), MAX_COMBINATIONS_TRIED):
        try:
            scenario.validate()
        except ScenarioError as error:
            for problem in error.problems:
                if problem["code"] in (*AXIS_ERRORS, ARM_ERROR):
                    at = next((node for key, node in nodes.items() if _same(key, problem["path"])), top["axes"])
                    more = {name: problem[name] for name in ("got", "allowed", "hint")}
                    reader.problem(at, problem["code"], problem["path"], problem["message"], **more)
        reader.finish()


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
