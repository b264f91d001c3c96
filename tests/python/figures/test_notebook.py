"""How runs, batches and scenarios are shown, completed, and handed to pandas and xarray."""

from __future__ import annotations

import base64
import re
import sys
from html.parser import HTMLParser
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from elbow_arms import as_elbow, scenario_of

PUSHED = """
format: 1
name: "push <b> & hold"
wall: {point: [1.72, 0.1, 0], acts_on_arm: true}
arm: {damping: [0.1, 0.1, 0.1]}
controller: {type: gravity_compensation}
initial: {q: [0.2, -0.5, 1.1]}
time: {stop: 2}
checks:
- {name: "peak <1 N>", summary: peak_force, below: 1.0}
- {name: one contact, count: make, equals: 1}
"""


@pytest.fixture(scope="module")
def pushed() -> arm3r.Run:
    return arm3r.Scenario(PUSHED).run()


# ---- text -----------------------------------------------------------------------------------------------------------


def test_failed_checks_are_in_the_representation(pushed: arm3r.Run) -> None:
    assert repr(pushed) == "<Run push <b> & hold: ok, 1 of 2 checks failed, 201 rows to t = 2 s>"
    scenario = arm3r.Scenario(PUSHED)
    scenario["checks"] = None
    assert "checks" not in repr(scenario.run())


def test_a_run_and_a_batch_become_dicts(pushed: arm3r.Run) -> None:
    columns = dict(pushed)
    assert list(columns) == pushed.columns and columns["q1"] is pushed["q1"]
    batch = arm3r.Scenario(PUSHED).batch({"time.stop": [0.1, 0.2]})
    assert dict(batch)["t_end"].tolist() == [0.1, 0.2] and list(dict(batch)) == batch.names


# ---- completion -----------------------------------------------------------------------------------------------------


def test_keys_are_completed(pushed: arm3r.Run) -> None:
    ipython = pytest.importorskip("IPython.core.completer")
    scenario = arm3r.Scenario(PUSHED)
    batch = scenario.batch({"time.stop": [0.1, 0.2]})
    completer = ipython.IPCompleter(namespace={"run": pushed, "scenario": scenario, "batch": batch})
    for text, whole in (
        ('run["tau_', "tau_g"),
        ('scenario["wall.contact.sti', "wall.contact.stiffness"),
        ('batch["peak', "peak_force"),
    ):
        completer.text_until_cursor = completer.line_buffer = text
        assert any(whole in found for found in completer.dict_key_matches(text)), text


def test_what_is_completed_can_be_read(pushed: arm3r.Run) -> None:
    assert all(key in pushed for key in pushed._ipython_key_completions_())
    assert {"q", "tip", "f_on_wall", "q1"} <= set(pushed._ipython_key_completions_())
    scenario = arm3r.Scenario(PUSHED)
    keys = scenario._ipython_key_completions_()
    assert {"wall", "wall.contact", "checks", "name", "controller.type"} <= set(keys)
    for key in keys:
        scenario[key]


def test_the_columns_of_a_sweep_are_completed_and_become_a_dict() -> None:
    table = object.__new__(arm3r.SweepTable)
    table.units = {"run": "", "peak_force": "N"}
    table.__dict__["_columns"] = {"run": np.arange(2), "peak_force": np.array([1.0, 2.0])}
    assert table._ipython_key_completions_() == list(dict(table)) == ["run", "peak_force"]


# ---- pages ----------------------------------------------------------------------------------------------------------


class Page(HTMLParser):
    """The elements, texts and images of a page; its tags must be closed in order."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: set[str] = set()
        self.words: list[str] = []
        self.images: list[bytes] = []
        self.feed(page)
        self.close()
        assert self.open == []
        self.text = " ".join(" ".join(self.words).split())

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.tags.add(tag)
        if tag == "img":
            kind, _, data = dict(attrs)["src"].partition(",")
            assert kind == "data:image/png;base64" and dict(attrs)["alt"]
            self.images.append(base64.b64decode(data))
        else:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def test_the_page_of_a_run(pushed: arm3r.Run) -> None:
    page = Page(pushed._repr_html_())
    assert "Run push <b> & hold ok" in page.text and "rows 201" in page.text
    assert "contact begins once" in page.text and "contact ends once" in page.text
    assert re.search(r"peak <1 N> failed \d+\.\d+ below 1", page.text) and "one contact passed 1" in page.text
    assert len(page.images) == 1 and page.images[0].startswith(b"\x89PNG") and len(page.images[0]) < 100_000


def test_a_run_that_broke_off_says_why() -> None:
    with pytest.raises(arm3r.BudgetError) as raised, pytest.warns(arm3r.ScenarioWarning):
        arm3r.Scenario("{format: 1, solver: {max_steps: 3}, initial: {q: [0, -30, 1]}}").run()
    page = Page(raised.value.run._repr_html_())
    assert "budget" in page.text and raised.value.run.summary["message"] in page.text
    assert "Warnings: initial.q[1] is more than a full turn" in page.text


def test_pages_of_runs_with_few_columns_and_from_files(pushed: arm3r.Run, tmp_path: Any) -> None:
    pushed.to_npz(tmp_path / "run.npz")
    assert "1 of 2" in repr(again := arm3r.Run.load(tmp_path / "run.npz"))
    assert Page(again._repr_html_()).images == Page(pushed._repr_html_()).images
    less = arm3r.Run({"t": pushed["t"]}, {"t": "s"}, {**pushed.summary, "checks": []}, None)
    assert len(Page(less._repr_html_()).images) == 1


def test_the_page_of_a_scenario() -> None:
    page = Page(arm3r.Scenario(PUSHED)._repr_html_())
    assert "Scenario push <b> & hold" in page.text and "controller gravity_compensation" in page.text
    assert "stiffness: 1000" in page.text and len(page.images) == 1
    free = arm3r.Scenario("{format: 1, initial: {q: [0, -30, 1]}}")
    assert "wall none" in Page(free._repr_html_()).text and "full turn" in Page(free._repr_html_()).text


def test_an_elbow_arm_without_offsets_looks_as_the_planar_arm() -> None:
    link = {"mass": 1.3, "com": 0.4, "inertia": [0.004, 0.031, 0.033]}
    planar: dict[str, Any] = {
        "convention": "simscape",
        "base_height": 0.2,
        "link1": {"mass": 0.6, "com": 0.1, "inertia_axial": 0.02},
        "link2": {"length": 0.8, **link},
        "link3": {"length": 0.6, **link},
    }
    elbow = as_elbow(planar)
    bent = {**elbow, "link2": {**elbow["link2"], "offset": 0.3}}
    pages = [Page(scenario_of(arm, initial={"q": [0.3, -0.5, 1.1]})._repr_html_()) for arm in (planar, elbow, bent)]
    assert pages[0].images == pages[1].images != pages[2].images


def test_the_page_of_a_scenario_that_is_not_valid() -> None:
    page = Page(arm3r.Scenario("{format: 1, wal: {}, time: {stop: -1}}", file="<i>.yaml")._repr_html_())
    assert "<i>.yaml not valid" in page.text and "did you mean wall?" in page.text and "time.stop" in page.text
    assert page.images == []


@pytest.mark.parametrize(
    ("values", "grid", "images"),
    [
        ({"wall.contact.stiffness": [1e2, 1e5, 1e3]}, False, 1),
        ({"wall.contact.stiffness": [1e2, 1e5], "wall.motion.velocity": [0.05, 0.1, 0.2]}, True, 1),
        ({"wall.contact.stiffness": [1e2, 1e5], "wall.motion.velocity": [0.05, 0.1]}, False, 0),
        ({"initial.q": [[0.2, -0.5, 1.1], [0.1, -0.5, 1.1]]}, False, 0),
        ({"solver.method": ["rk4", "dopri5"]}, False, 0),
        ({"wall.contact.stiffness": [-1.0, -2.0]}, False, 0),
        ({"time.stop": []}, False, 0),
        ({}, False, 0),
    ],
)
def test_the_page_of_a_batch(values: dict[str, Any], grid: bool, images: int) -> None:
    batch = arm3r.Scenario(PUSHED).batch(values, grid=grid)
    page = Page(batch._repr_html_())
    assert f"runs {len(batch)}" in page.text and len(page.images) == images
    if len(batch) and batch.ok.all():
        assert f"{len(batch)} ok" in page.text and "peak_force N" in page.text


def test_pages_leave_pyplot_alone(pushed: arm3r.Run) -> None:
    import matplotlib.pyplot as plt

    before, style = plt.get_fignums(), dict(plt.rcParams)
    scenario = arm3r.Scenario(PUSHED)
    for shown in (scenario, pushed, scenario.batch({"wall.contact.stiffness": [1e2, 1e3]})):
        assert "<img" in shown._repr_html_()
    assert plt.get_fignums() == before and dict(plt.rcParams) == style


# ---- pandas and xarray ----------------------------------------------------------------------------------------------


def test_a_run_in_pandas(pushed: arm3r.Run) -> None:
    pytest.importorskip("pandas")
    frame = pushed.to_pandas()
    assert frame.index.name == "t" and np.array_equal(frame.index, pushed["t"])
    assert list(frame.columns) == pushed.columns[1:] and frame.attrs["units"]["tau1"] == "N m"
    assert all(np.array_equal(frame[name], pushed[name]) for name in frame.columns)


def test_a_run_in_xarray(pushed: arm3r.Run) -> None:
    pytest.importorskip("xarray")
    data = pushed.to_xarray()
    assert data.sizes == {"t": len(pushed)} and list(data.data_vars) == pushed.columns[1:]
    assert data["depth"].attrs == {"units": "m"} and data["t"].attrs == {"units": "s"}
    assert all(np.array_equal(data[name], pushed[name]) for name in pushed.columns)
    assert data.attrs["hash"] == pushed.summary["hash"]


BATCHES: list[tuple[dict[str, Any], bool, tuple[str, ...]]] = [
    ({"wall.contact.stiffness": [1e2, 1e4, 1e3]}, False, ("wall.contact.stiffness",)),
    ({"wall.contact.stiffness": [1e2, 1e4], "time.stop": [0.1, 0.2]}, False, ("run",)),
    (
        {"wall.contact.stiffness": [1e2, 1e4], "time.stop": [0.1, 0.2, 0.3]},
        True,
        ("wall.contact.stiffness", "time.stop"),
    ),
    ({"initial.q": [[0.2, -0.5, 1.1], [0.1, -0.5, 1.1]], "time.stop": 0.1}, True, ("initial.q",)),
    ({"time.stop": [[0.1, 0.2], [0.3, 0.4]]}, False, ("axis_0", "axis_1")),
    ({"time.stop": [[0.1], [0.2]], "wall.contact.stiffness": [[1e2, 1e3], [1e4, 1e5]]}, False, ("axis_0", "axis_1")),
    ({"solver.method": ["rk4", "dopri5"]}, False, ("solver.method",)),
    ({"time.stop": [0.1]}, False, ("time.stop",)),
    ({}, False, ()),
]


@pytest.mark.parametrize(("values", "grid", "dimensions"), BATCHES)
def test_a_batch_in_xarray(values: dict[str, Any], grid: bool, dimensions: tuple[str, ...]) -> None:
    pytest.importorskip("xarray")
    batch = arm3r.Scenario(PUSHED).batch(values, grid=grid)
    data = batch.to_xarray()
    assert data["t_end"].dims == dimensions and data["t_end"].shape == batch.shape
    assert np.array_equal(data["outcome"], batch.outcomes) and data["peak_force"].attrs == {"units": "N"}
    for index in np.ndindex(batch.shape):
        scenario, here = batch.scenario(index), data.isel(dict(zip(dimensions, index, strict=True)))
        assert float(here["peak_force"]) == batch["peak_force"][index]
        names = [name for name in data.coords if name in scenario and name not in ("initial.q",)]
        assert len(names) >= len(values)
        assert all(here[name].item() == scenario[name] for name in names)


@pytest.mark.parametrize(("values", "grid", "dimensions"), BATCHES)
def test_a_batch_in_pandas(values: dict[str, Any], grid: bool, dimensions: tuple[str, ...]) -> None:
    pytest.importorskip("pandas")
    batch = arm3r.Scenario(PUSHED).batch(values, grid=grid)
    frame = batch.to_pandas()
    assert len(frame) == len(batch) and frame.index.name == "run" and set(frame["outcome"]) == {"ok"}
    for row, index in enumerate(np.ndindex(batch.shape)):
        scenario = batch.scenario(index)
        names = [name for name in frame.columns if name in scenario]
        assert len(names) >= len(values)
        assert all(frame[name][row] == scenario[name] for name in names)
        assert frame["t_end"][row] == batch["t_end"][index]


@pytest.mark.parametrize("library", ["pandas", "xarray"])
def test_a_missing_library_is_named_with_its_extra(
    pushed: arm3r.Run, library: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    batch = arm3r.Scenario(PUSHED).batch({})
    for made in (pushed, batch):
        with pytest.raises(arm3r.UsageError, match=rf"^{library} is not installed; .*'arm3r_cpp\[{library}\]'"):
            getattr(made, f"to_{library}")()
