"""Sweep files: what is wrong is named with its place, all of it at once."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.sweeps.axes import DISTRIBUTIONS, SPACES
from arm3r_cpp.sweeps.shard import STATISTICS
from conftest import ROOT

GOOD = """\
format: 1
scenario: {time: {stop: 0.1}}
axes:
  - {key: time.stop, values: [0.1, 0.2]}
"""
HEAD = "format: 1\nscenario: {wall: {}, time: {stop: 0.1}}\n"


def message(text: str, **options: object) -> str:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Sweep(text, file="s.yaml", **options)
    assert len(raised.value.problems) == len(str(raised.value).splitlines())
    return str(raised.value)


def axis(text: str, more: str = "") -> str:
    return f"{HEAD}axes:\n  - {text}\n{more}"


MISTAKES = [
    (GOOD.replace("axes", "axis"),
     ["s.yaml:3:1: ", "axis", "did you mean axes?", "s.yaml:1:1: ", "axes: this must be given"]),
    (GOOD.replace("format: 1\n", ""), ["s.yaml:1:1: ", "sweep.format", "write `format: 1`"]),
    ("format: 1\naxes: []\n", ["s.yaml:2:7: ", "axes: expects a list such as [{key: ", "scenario: this must be given"]),
    (axis("{key: wall.contact.stifness, values: [1]}"),
     ["s.yaml:4:11: ", "axes[0].key", "got wall.contact.stifness", "mean wall.contact.stiffness?"]),
    (axis("{key: time.stop, value: [1]}"), ["s.yaml:4:22: ", "axes[0].value", "mean values?", "one rule is needed"]),
    (axis("{key: time.stop, values: []}"), ["s.yaml:4:30: ", "axes[0].values: expects a list of values"]),
    (axis("{key: time.stop, values: [1, 2 s]}"), ["s.yaml:4:34: ", "axes[0].values[1]", "got 2 s", "write 2 (s)"]),
    (axis("{key: time.stop, values: [10 deg]}"), ["s.yaml:4:31: ", "can be given in degrees"]),
    (axis("{key: time.stop, values: [1, [2, 3]]}"), ["s.yaml:4:34: ", "axes[0].values[1]", "alike", "got a list of 2"]),
    (axis("{key: time.stop, linspace: [0, 1]}"),
     ["s.yaml:4:32: ", "axes[0].linspace: expects [from, to, count]", "a list of 2"]),
    (axis("{key: time.stop, linspace: [0, 1, 2.5]}"), ["s.yaml:4:39: ", "whole number", "got 2.5"]),
    (axis("{key: time.stop, linspace: [0, 1, 0]}"), ["axes[0].linspace[2]: out of range, got 0", "[1, 1.0e+10]"]),
    (axis("{key: time.stop, geomspace: [0, 1, 3]}"), ["axes[0].geomspace", "got [0, 1, 3]", "numbers above 0"]),
    (axis("{key: time.stop, uniform: [0, 1]}"),
     ["s.yaml:4:22: ", "belongs to mode random or latin_hypercube; here the mode is grid"]),
    (axis("{key: time.stop, uniform: [1, 0]}", "mode: random\nruns: 3\n"), ["the smaller number first", "got [1, 0]"]),
    (axis("{key: time.stop, normal: [1, 0]}", "mode: random\nruns: 3\n"), ["deviation above 0"]),
    (axis("{key: time.stop, uniform: [0, 1]}", "mode: random\n"),
     ["s.yaml:5:1: ", "runs: this must be given", "a whole number; mode is random"]),
    (axis("{key: time.stop, values: [1]}", "runs: 3\n"),
     ["s.yaml:5:1: ", "belongs to mode random or latin_hypercube; here the mode is grid"]),
    (axis("{key: time.stop, values: [1]}", "mode: gird\n"), ["s.yaml:5:7: ", "got gird", "did you mean grid?"]),
    (axis("{key: time.stop, values: [1]}\n  - {key: time.stop, values: [2]}"), ["s.yaml:5:5: ", "twice", "time.stop"]),
    (axis("{key: time.stop, values: [1, 2]}\n  - {key: \"initial.q[0]\", values: [2]}", "mode: list\n"),
     ["s.yaml:3:1: ", "axes", "one length", "got time.stop 2, initial.q[0] 1"]),
    (axis("{key: time.stop, linspace: [1, 2, 1000000]}\n  - {key: \"initial.q[0]\", linspace: [0, 1, 1000000]}"),
     ["s.yaml:3:1: ", "got time.stop 1000000 x initial.q[0] 1000000", "at most 1.0e+10", "latin_hypercube"]),
    (axis("{key: solver.method, values: [rk4, rk5]}"), ["s.yaml:4:40: ", "axes[0].values[1]", "got rk5", "mean rk4?"]),
    (axis("{key: solver.method, values: [1]}"), ["axes[0].values[0]", "got 1", "dopri5"]),
    (axis("{key: initial.q, values: [[1, 2]]}"), ["s.yaml:4:5: ", "initial.q", "(..., 3)"]),
    (axis("{key: solver.step, values: [1e-3]}"), ["s.yaml:4:5: ", "solver.step", "rk4"]),
    (axis("{key: wall, values: [1]}"), ["s.yaml:4:11: ", "got wall", "no sections"]),
    (axis("{key: time.stop, values: [1]}", "metrics: [peak_forc]\n"), ["s.yaml:5:11: ", "did you mean peak_force?"]),
    (axis("{key: time.stop, values: [1]}", "metrics: [q1, q1]\n"), ["s.yaml:5:15: ", "twice"]),
    (axis("{key: time.stop, values: [1]}", "statistics: [{column: dept, of: max}]\n"),
     ["s.yaml:5:23: ", "statistics[0].column", "mean depth?"]),
    (axis("{key: time.stop, values: [1]}", "statistics: [{column: q1, of: median}]\n"), ["got median", "max_abs"]),
    (axis("{key: time.stop, values: [1]}", "statistics: [{column: q1}]\n"),
     ["s.yaml:5:14: ", "statistics[0].of: this must be given", "max_abs"]),
    (axis("{key: time.stop, values: [1]}", "shard: 0\n"), ["s.yaml:5:8: ", "shard", "[1, 1.0e+6]"]),
    (axis("{key: time.stop, values: [1]}", "set: {time.stopp: 3}\n"), ["s.yaml:5:7: set time.stopp=3", "mean stop?"]),
    (axis("{key: time.stop, values: [1]}", "set: {time.log_every: -3}\n"), ["s.yaml:5:7: set time.log_every=-3"]),
    (GOOD.replace("stop: 0.1}", "stop: 0.1, stap: 1}"), ["s.yaml:2:30: ", "time.stap"]),
    (GOOD.replace("{time: {stop: 0.1}}", "\n  time:\n    stop: -1"), ["s.yaml:4:11: ", "time.stop", "got -1"]),
    (GOOD.replace("{time: {stop: 0.1}}", "nowhere.yaml"), ["s.yaml:2:11: ", "nowhere.yaml", "cannot be read"]),
    (GOOD + "  - *x\n", ["anchors and aliases"]),
    (GOOD + "mode: grid\nmode: list\n", ["s.yaml:6:1: ", "mode", "on line 5"]),
    ("format: 1\nscenario: [\n", ["s.yaml:3:1: ", "not valid YAML"]),
    (axis("{key: initial.q, values: [[0, 0, 1]]}\n  - {key: 'initial.q[1]', values: [0.3]}"),
     ["s.yaml:5:5: ", "axes[1].key", "initial.q[1] varies twice", "take one"]),
    (axis("{key: wall.motion.velocity, values: [[0.1, 0, 0], [0.2, 0, 0]]}"),
     ["s.yaml:4:5: ", "wall.motion.velocity", "one number", "a list of 3", "`set` it"]),
    (axis("{key: 'wall.point[1]', linspace: [-1e308, 1e308, 3]}"), ["s.yaml:4:38: ", "finite numbers"]),
    (axis("{key: wall.contact.stiffness, geomspace: [1e-300, 1e300, 3]}"), ["s.yaml:4:46: ", "out of range"]),
    (axis("{key: 'wall.point[1]', uniform: [-1e308, 1e308]}", "mode: random\nruns: 3\n"), ["s.yaml:4:37: ", "range"]),
    (axis("{key: 'wall.point[1]', normal: [0, 1e308]}", "mode: random\nruns: 3\n"), ["s.yaml:4:36: ", "range"]),
    (axis("{key: time.stop, values: [1]}", "seed: 9007199254740993\n"),
     ["s.yaml:5:7: ", "seed", "[0, 9007199254740991]"]),
    (GOOD.replace("{time: {stop: 0.1}}", '{"a: b": 1}'), ["s.yaml:2:12: ", "a: b: no such key"]),
    (GOOD.replace("{time: {stop: 0.1}}", '{time: {"st,op": 1}}'), ["s.yaml:2:19: ", "time.st,op", "no such key"]),
    (GOOD.replace("{time: {stop: 0.1}}", '{"a\\nb": 1}'), ["s.yaml:2:12: ", r"a\nb: no such key"]),
    (axis("{key: \"time.\\nstop\", values: [1]}"), ["s.yaml:4:11: ", r"time.\nstop", "mean time.stop?"]),
    (axis("{key: time.stop, log_uniform: [0, 1]}", "mode: random\nruns: 3\n"), ["got [0, 1]", "numbers above 0"]),
    (axis("{key: time.stop, log_uniform: [2, 1]}", "mode: random\nruns: 3\n"), ["got [2, 1]", "smaller one first"]),
    (axis("{key: time.stop, values: [1], linspace: [1, 2, 3]}"), ["s.yaml:4:5: ", "one rule", "got values, linspace"]),
    (axis("{key: time.stop, values: [1]}", "statistics: [{column: force_ref, of: max}]\n"),
     ["s.yaml:5:14: ", "statistics[0].column", "got force_ref", "tip_x"]),
    (axis("{key: time.stop, values: [1]}", "statistics: [{column: q1, of: max}, {column: q1, of: max}]\n"),
     ["s.yaml:5:37: ", "statistics[1]", "twice"]),
    (axis("{key: time.stop, values: [1]}", "statistics: [q1]\n"), ["s.yaml:5:14: ", "statistics[0]: expects a map"]),
    (axis("{key: wall.point, values: [[0, 0, 1 cm]]}"), ["s.yaml:4:39: ", "axes[0].values[0][2]", "write 0.01 (m)"]),
    (axis("{key: wall.acts_on_arm, values: [yes]}"), ["s.yaml:4:38: ", "got yes", "write true"]),
    (axis("{key: wall.size, values: [infinite, inf]}"), ["s.yaml:4:41: ", "axes[0].values[1]", "alike"]),
    (axis("{key: arm.urdf, values: [{a: b}]}"), ["s.yaml:4:30: ", "axes[0].values[0]"]),
    (axis("{key: time.stop, values: [1]}", "set: 5\nseed:\n"),
     ["s.yaml:5:6: ", "a map of values", "seed", "got nothing"]),
    (axis("{key: time.stop, values: [1]}", "set: {a..b: 1}\n"), ["s.yaml:5:7: set a..b=1: ", "words joined by points"]),
    ("5\n", ["s.yaml:1:1: ", "a sweep is a map of keys, got 5", "format: 1"]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "words"), MISTAKES, ids=lambda part: part[-1][:40] if isinstance(part, list) else "")
def test_mistakes_have_a_place_and_a_fix(text: str, words: list[str]) -> None:
    found = message(text)
    assert all(word in found for word in words), found


@pytest.mark.parametrize("scenario", ["[1]", "", '""', "/"])
def test_a_mistake_is_listed_once(scenario: str) -> None:
    assert len(message(GOOD.replace("{time: {stop: 0.1}}", scenario)).splitlines()) == 1


def test_all_mistakes_are_listed_at_once() -> None:
    found = message(axis("{key: tim.stop, values: [1]}", "mods: grid\nshard: -1\nmetrics: [x]\n"))
    assert len(found.splitlines()) == 4


def test_problems_are_dicts_as_of_a_scenario() -> None:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Sweep(axis("{key: tim.stop, values: [1]}"), file="s.yaml")
    (problem,) = raised.value.problems
    assert raised.value.code == problem["code"] == "sweep.unknown_word"
    assert set(problem) == {"code", "message", "file", "line", "column", "path", "got", "allowed", "hint"}


def test_a_scenario_lies_beside_its_sweep(tmp_path: Path, moving_wall: Path) -> None:
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep/base.yaml").write_bytes(moving_wall.read_bytes())
    (tmp_path / "deep/sweep.yaml").write_text(GOOD.replace("{time: {stop: 0.1}}", "base.yaml"))
    plan = arm3r.Sweep.load(tmp_path / "deep/sweep.yaml", overrides=["wall.contact.stiffness=77"])
    assert plan.scenario.name == "moving-wall" and plan.scenario["wall.contact.stiffness"] == 77


def test_faults_of_the_scenarios_file_have_its_own_places(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text("format: 1\ntime: {stop: -1}\n")
    (tmp_path / "sweep.yaml").write_text(GOOD.replace("{time: {stop: 0.1}}", "base.yaml"))
    with pytest.raises(arm3r.ScenarioError, match=r"base\.yaml:2:14: .*time\.stop"):
        arm3r.Sweep.load(tmp_path / "sweep.yaml")


def test_set_goes_before_the_overrides() -> None:
    text = GOOD + "set: {time.log_every: 0.05, initial.q: [0, 10 deg, 0], name: 'a, b', wall: {'face_offset': 0.25}}\n"
    plan = arm3r.Sweep(text, overrides=["initial.q[1]=0.5"])
    assert plan.scenario.name == "a, b" and plan.scenario["wall.face_offset"] == 0.25
    assert plan.scenario["time.log_every"] == 0.05 and plan.scenario["initial.q[1]"] == 0.5


def test_angles_may_be_in_degrees() -> None:
    plan = arm3r.Sweep(axis('{key: "initial.q[1]", linspace: [-30 deg, -20 deg, 3]}'))
    assert plan.values()["initial.q[1]"] == pytest.approx(np.deg2rad([-30, -25, -20]), rel=1e-13)
    plan = arm3r.Sweep(axis("{key: initial.q, values: [[0, 30 deg, 0.5]]}"))
    assert plan.values()["initial.q"][0] == pytest.approx([0, np.pi / 6, 0.5], rel=1e-15)


AS_MAP = {"format": 1, "scenario": {}, "axes": [{"key": "time.stop", "values": [0, 0.1]}]}


def test_a_map_is_as_good_as_a_file() -> None:
    plan = arm3r.Sweep({"format": 1, "scenario": {"name": "a, b"}, "axes": [{"key": "time.stop", "values": (1, 2.5)}]})
    assert plan.scenario.name == "a, b" and plan.values()["time.stop"].tolist() == [1, 2.5]
    plan = arm3r.Sweep({**AS_MAP, "set": {"initial.q[1]": 0.5, "wall": {"point": [1.9, 0, 0]}}})
    assert plan.scenario["initial.q[1]"] == 0.5 and plan.scenario["wall.point[0]"] == 1.9
    with pytest.raises(arm3r.ScenarioError, match="a, b: no such key"):
        arm3r.Sweep({**AS_MAP, "a, b": 1})


def test_what_cannot_be_read() -> None:
    with pytest.raises(arm3r.UsageError, match=r"nowhere\.yaml"):
        arm3r.Sweep.load("nowhere.yaml")
    with pytest.raises(arm3r.UsageError, match="PATH=VALUE"):
        arm3r.Sweep(GOOD, overrides=["time.stop"])
    with pytest.raises(arm3r.UsageError, match=r"Sweep\.load"):
        arm3r.Sweep(__file__)
    with pytest.raises(arm3r.ScenarioError, match=r"s\.yaml:1:11: .*UTF-8"):
        arm3r.Sweep(b"format: 1 \xff", file="s.yaml")
    with pytest.raises(arm3r.UsageError, match="not a regular file"):
        arm3r.Sweep.load("/dev/zero")
    for strange in ({"file": "n\udcff.yaml"}, {"overrides": ["name=\udcff"]}):
        with pytest.raises(arm3r.UsageError, match="is not UTF-8"):
            arm3r.Sweep(GOOD, **strange)


def test_whole_numbers_may_have_an_exponent() -> None:
    plan = arm3r.Sweep(
        axis("{key: solver.max_steps, linspace: [1.0e+3, 2.0e+3, 1.1e+1]}", "shard: 1.0e+2\nseed: 1e15\n")
    )
    assert (plan.runs, plan.shard, plan.seed) == (11, 100, 10**15) and isinstance(plan.seed, int)


def test_whether_a_value_is_in_range_is_judged_run_by_run() -> None:
    for key, values in [("solver.rtol", "1.0e-9, 5"), ("solver.max_steps", "100, 2.5"), ("time.log_every", "0.1, inf")]:
        assert arm3r.Sweep(axis(f"{{key: {key}, values: [{values}]}}")).runs == 2


def test_values_of_an_axis_keep_their_kinds() -> None:
    text = axis("{key: push.duration, values: [1, inf]}\n  - {key: wall.size, values: [infinite]}"
                "\n  - {key: wall.acts_on_arm, values: [true, false]}", "set: {push: {}}\n")  # fmt: skip
    items = [axis.items for axis in arm3r.Sweep(text).axes]
    assert items == [(1.0, np.inf), ("infinite",), (True, False)] and isinstance(items[0][0], float)


def test_the_page_about_sweeps_is_true(root: Path) -> None:
    page = (root / "docs/sweeps.md").read_text()
    text = page.split("```yaml\n")[1].split("```")[0]
    plan = arm3r.Sweep(text, file=str(root / "of_the_page.yaml"))
    assert plan.runs == 40 * 21 * 2 and [statistic.name for statistic in plan.statistics] == ["depth.max"]


SCHEMA: Any = json.loads((ROOT / "docs/sweep.schema.json").read_text())
AXIS, STATISTIC = (SCHEMA["properties"][key]["items"]["properties"] for key in ("axes", "statistics"))


def test_the_page_has_every_key_with_its_meaning_and_default(root: Path) -> None:
    """The rows are those of the table in the library, which the schema is made of."""
    page = (root / "docs/sweeps.md").read_text()
    for key, value in SCHEMA["properties"].items():
        default = "required" if key in SCHEMA["required"] else value.get("default", "")
        assert f"| `{key}` | {value['description']} | {default} |\n" in page
    for rule in list(AXIS)[1:]:
        assert f"| `{rule}` | {AXIS[rule]['description']} |\n" in page


def test_the_words_of_the_table_are_those_that_are_computed() -> None:
    assert STATISTIC["of"]["enum"] == list(STATISTICS) and list(AXIS) == ["key", "values", *SPACES, *DISTRIBUTIONS]


def test_the_examples_are_good(root: Path) -> None:
    files = sorted((root / "scenarios/sweeps").glob("*.yaml"))
    assert len(files) >= 4
    assert all(arm3r.Sweep.load(file).runs > 10 for file in files)
