"""Figures of force control: what they take from a run, what stands on them, and the command that writes them."""

from __future__ import annotations

import math
import shutil
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import force_runs
import numpy as np
import pytest
from arm3r_cpp.commands import plot as plot_cli
from arm3r_cpp.plot.comparison import shortened
from arm3r_cpp.plot.force_run import ForceRun
from arm3r_cpp.plot.style import RC
from arm3r_cpp.plot.wall_frame import wall_frame
from figure_faults import crowded
from matplotlib import rcParams
from matplotlib.colors import same_color
from matplotlib.figure import Figure

pytestmark = pytest.mark.filterwarnings("error")  # such as a layout that does not fit
PANELS = ["pressing force, N", "path error, mm", "torque, N m", "residual, N m"]
BELOW = ["pressing force, N", "along $e_2$, m"]


@pytest.fixture(autouse=True)
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files of few pixels are written sooner."""
    monkeypatch.setitem(RC, "savefig.dpi", 40)


@pytest.fixture(scope="module")
def hybrid() -> arm3r.Run:
    return force_runs.hybrid()


@pytest.fixture(scope="module")
def proportional() -> arm3r.Run:
    return force_runs.hybrid(name="without integral", ki=0.0)


@pytest.fixture(scope="module")
def bounce() -> arm3r.Run:
    return force_runs.bounce()


@pytest.fixture(scope="module")
def pushed() -> arm3r.Run:
    """A run without force control that meets a wall."""
    return arm3r.Scenario("""
format: 1
wall: {point: [1.74, 0, 0], acts_on_arm: true}
controller: {type: gravity_compensation}
time: {stop: 1}
""").run()


@pytest.fixture(scope="module")
def fall() -> arm3r.Run:
    return arm3r.Scenario("{format: 1, name: fall, time: {stop: 0.1}}").run()


@cache
def figure_of(run: arm3r.Run) -> Figure:
    """The figure of a run that several tests look at and none changes."""
    return arm3r.plot.force(run)


def labels(figure: Figure) -> list[str]:
    return [ax.get_ylabel().replace("\n", " ") for ax in figure.axes if ax.axison]


def panel(figure: Figure, label: str) -> Any:
    return next(ax for ax in figure.axes if ax.get_ylabel().replace("\n", " ") == label)


def lines(ax: Any) -> dict[str, Any]:
    return {line.get_label(): line for line in ax.lines}


def legend(ax: Any) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()]


# ---- what is taken from the run -------------------------------------------------------------------------------------


def test_the_frame_of_the_wall_is_that_of_the_library() -> None:
    """Its depth column says so, for a plate that slants and turns."""
    run = arm3r.Scenario("""
format: 1
wall:
  point: [1.9, 0.3, -0.2]
  normal: [-2, -0.5, 0.7]
  rotation: {type: sinusoid, axis: [0.3, 1, -0.4], amplitude: 0.4, frequency: 0.7, phase: 0.5}
  face_offset: 0.003
  size: infinite
controller: {type: gravity_compensation}
time: {stop: 2, log_every: 0.05}
""").run()
    frame = wall_frame(arm3r.Scenario(run.summary["scenario"]), run.t)
    depth = np.sum(frame.normal * (run["wall"] - run["tip"]), axis=1) + 0.003
    assert depth == pytest.approx(run["depth"], abs=1e-12)
    basis = np.stack([frame.normal, frame.e1, frame.e2], axis=1)
    assert basis @ basis.transpose(0, 2, 1) == pytest.approx(np.tile(np.eye(3), (len(run), 1, 1)), abs=1e-12)
    assert np.ptp(frame.normal, axis=0).max() > 0.3


@pytest.mark.parametrize(
    ("normal", "e1", "e2"),
    [((-3, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 0, 2), (0, 1, 0), (1, 0, 0)), ((0, -1, 0), (-1, 0, 0), (0, 0, 1))],
)
def test_the_plates_axes_at_rest(normal: Any, e1: Any, e2: Any) -> None:
    scenario = arm3r.Scenario(f"{{format: 1, wall: {{normal: {list(normal)}}}}}")
    frame = wall_frame(scenario, [0.0, 3.0])
    assert frame.e1 == pytest.approx(np.array([e1, e1]))
    assert frame.e2 == pytest.approx(np.array([e2, e2]))


def test_a_peak_that_rows_show_is_where_they_show_it(hybrid: arm3r.Run) -> None:
    peak = ForceRun(hybrid).peak
    assert peak is not None
    assert peak.seen
    assert peak.force == hybrid.summary["peak_force"]
    assert peak.t == hybrid.t[hybrid["force"].argmax()]


def test_a_peak_between_rows_is_put_where_the_contact_was(bounce: arm3r.Run) -> None:
    make, broken = (event.t for event in bounce.events)
    peak = ForceRun(bounce).peak
    assert peak is not None
    assert not peak.seen
    assert peak.force == 11.8
    assert bounce["force"].max() == pytest.approx(5)
    assert peak.t == pytest.approx((make + broken) / 2, abs=1e-9)  # a parabola that is zero at both has its top there


def test_a_contact_that_no_row_saw_does_not_take_the_peak_of_one_that_explains_it(bounce: arm3r.Run) -> None:
    unseen = [force_runs.event(kind, t) for kind, t in (("make", 0.601), ("break", 0.609))]
    peak = ForceRun(force_runs.changed(bounce, {}, events=[*bounce.summary["events"], *unseen])).peak
    assert peak is not None
    assert peak.t == pytest.approx(0.5025, abs=1e-3)


def test_a_peak_that_no_row_saw_is_put_into_the_longest_such_contact(bounce: arm3r.Run) -> None:
    events = [
        force_runs.event(kind, t) for kind, t in zip(("make", "break") * 2, (0.201, 0.203, 0.601, 0.609), strict=True)
    ]
    unseen = force_runs.changed(bounce, {"force": 0 * bounce.t}, events=events)
    peak = ForceRun(unseen).peak
    assert peak is not None
    assert peak.t == pytest.approx(0.605)


def test_no_force_no_peak(bounce: arm3r.Run) -> None:
    silent = force_runs.changed(bounce, {"force": 0 * bounce.t}, events=[], peak_force=0.0, metrics={})
    assert ForceRun(silent).peak is None


def test_force_without_its_column_is_the_normal_part_of_the_force_on_the_tip(hybrid: arm3r.Run) -> None:
    along = {f"f_on_tip_{c}": hybrid[f"f_on_tip_{c}"] + 3 * axis for c, axis in zip("xyz", force_runs.E1, strict=True)}
    rubbed = force_runs.without(force_runs.changed(hybrid, along), "force")
    assert ForceRun(rubbed).force == pytest.approx(hybrid["force"], abs=1e-9)


def test_the_estimate_ends_where_the_force_does(hybrid: arm3r.Run) -> None:
    estimate = ForceRun(hybrid).estimate
    assert estimate is not None
    assert estimate[-1] == pytest.approx(20, abs=0.05)


def test_the_tip_on_the_face(hybrid: arm3r.Run) -> None:
    wanted = ForceRun(hybrid).on_contact_plane("tip_ref")
    assert wanted is not None
    assert wanted[0] == pytest.approx([0.05, 0.13])
    assert np.linalg.norm(wanted - [-0.05, 0.13], axis=1) == pytest.approx(0.1, abs=1e-12)


def test_errors_are_those_along_the_face_where_force_is_controlled(hybrid: arm3r.Run) -> None:
    assert not ForceRun(hybrid).path_error["n"][hybrid["force_phase"] > 0].any()
    free = ForceRun(force_runs.without(hybrid, "force_phase"))
    assert free.path_error["n"] == pytest.approx(-hybrid["depth"], abs=1e-12)
    size = np.linalg.norm(list(free.path_error.values()), axis=0)
    assert size == pytest.approx(np.linalg.norm(hybrid["tip"] - hybrid["tip_ref"], axis=1), abs=1e-12)


def test_the_force_error_is_told_in_contact_only(hybrid: arm3r.Run) -> None:
    error = ForceRun(hybrid).error
    assert error is not None
    assert np.isnan(error[hybrid["contact"] == 0]).all()
    assert error[-1] == pytest.approx(0, abs=1e-3)


def test_limits_come_from_the_summary_or_its_scenario(hybrid: arm3r.Run) -> None:
    assert ForceRun(hybrid).torque_limit == [20, 30, 25]
    told = force_runs.changed(hybrid, {}, torque_limit=[7.5, None, 3])
    assert ForceRun(told).torque_limit == [7.5, math.inf, 3]
    assert ForceRun(hybrid).threshold == [8, 6, 3]


# ---- the figure -----------------------------------------------------------------------------------------------------


def test_all_panels(hybrid: arm3r.Run) -> None:
    figure = figure_of(hybrid)
    assert labels(figure) == PANELS + BELOW
    assert figure.axes[3].get_xlabel() == "t, s"
    assert figure.axes[0].get_xlim() == (0, 4)


@pytest.mark.parametrize(
    ("missing", "gone"),
    [
        (("tip_ref",), {"path error, mm"}),
        (("residual",), {"residual, N m"}),
        (("wall", "depth"), {"along $e_2$, m"}),
        (("force_measured", "f_estimate", "force_phase", "saturated"), set()),
    ],
)
def test_panels_without_columns_are_left_out(hybrid: arm3r.Run, missing: tuple[str, ...], gone: set[str]) -> None:
    figure = arm3r.plot.force(force_runs.without(hybrid, *missing))
    assert set(labels(figure)) == {*PANELS, *BELOW} - gone


def test_panels_of_other_laws(hybrid: arm3r.Run) -> None:
    t = hybrid.t
    more = {"q_ref1": hybrid["q1"] - 0.002, "q_ref2": hybrid["q2"], "q_ref3": hybrid["q3"], "tank_energy": 0.05 + 0 * t,
            "stiffness_estimate": 5000 * (t > 1), "identifiable": t > 1, "collision": t > 2}  # fmt: skip
    figure = arm3r.plot.force(force_runs.changed(hybrid, more))
    assert {"joint error, mrad", "stiffness, N/m", "energy, J"} <= set(labels(figure))
    assert lines(panel(figure, "joint error, mrad"))["$q_1$"].get_ydata() == pytest.approx(2)
    stiffness = lines(panel(figure, "stiffness, N/m"))
    assert np.isnan(stiffness["estimated"].get_ydata()).tolist() == (t <= 1).tolist()
    assert set(stiffness["the wall's"].get_ydata()) == {5000}
    assert "collision" in legend(panel(figure, "residual, N m"))


def test_forces_are_drawn_as_they_were(hybrid: arm3r.Run) -> None:
    drawn = lines(figure_of(hybrid).axes[0])
    assert np.interp(hybrid.t, *drawn["true"].get_data()) == pytest.approx(hybrid["force"])
    assert drawn["measured"].get_ydata().tolist() == hybrid["force_measured"].tolist()
    assert set(drawn["reference"].get_ydata()) == {20}
    assert drawn["estimated"].get_ydata()[-1] == pytest.approx(20, abs=0.05)


def test_the_peak_is_marked_at_its_time_and_level(hybrid: arm3r.Run, bounce: arm3r.Run) -> None:
    t = hybrid.t[hybrid["force"].argmax()]
    label = f"peak {hybrid.summary['peak_force']:.4g} N, t = {t:.4f} s"
    (mark,) = (line for line in figure_of(hybrid).axes[0].lines if line.get_label() == label)
    assert mark.get_xydata().tolist() == [[t, hybrid.summary["peak_force"]]]
    marks = lines(figure_of(bounce).axes[0])
    (label,) = (label for label in marks if "peak" in label)
    assert label.startswith("peak 11.8 N, t ≈ 0.50")
    assert marks[label].get_ydata().tolist() == [11.8]


def test_the_peak_of_the_first_contact_is_told_beside_a_larger_one(hybrid: arm3r.Run) -> None:
    make = hybrid.events[0].t
    told = {**hybrid.summary["metrics"], "peak_force_time": 3.0}
    told |= {"first_contact_peak": 12.5, "first_contact_peak_time": make + 0.01}
    figure = arm3r.plot.force(force_runs.changed(hybrid, {}, metrics=told), panels=["force", "first_contact"])
    for ax in figure.axes:
        (mark,) = (line for line in ax.lines if "first contact's" in line.get_label())
        assert mark.get_label() == f"first contact's peak 12.5 N, t = {make + 0.01:.4f} s"
        assert mark.get_xydata().tolist() == [[make + 0.01, 12.5]]
    assert len([label for label in legend(figure.axes[0]) if "peak" in label]) == 2
    told["peak_force_time"] = make + 0.01
    ax = arm3r.plot.force(force_runs.changed(hybrid, {}, metrics=told), panels=["force"]).axes[0]
    assert next(label for label in legend(ax) if "peak" in label).endswith("s (first contact)")
    late = arm3r.plot.force(force_runs.changed(hybrid, {}, metrics=told), panels=["force"], start=1.0).axes[0]
    assert not any("first contact" in label for label in legend(late))


def test_force_is_zero_where_contact_is_made_and_lost_between_rows(bounce: arm3r.Run) -> None:
    t, force = lines(figure_of(bounce).axes[0])["true"].get_data()
    for event in bounce.events:
        assert force[np.flatnonzero(t == event.t)].tolist() == [0]


def test_settling_is_marked_with_its_band(hybrid: arm3r.Run) -> None:
    ax = figure_of(hybrid).axes[0]
    assert "±5 %, settles in 0.215 s" in legend(ax)
    upright = [
        line.get_xdata()[0] for line in ax.lines if len(set(line.get_xdata())) == 1 and len(line.get_xdata()) == 2
    ]
    assert upright == [pytest.approx(hybrid.events[0].t + hybrid.summary["metrics"]["settling_time"])]
    (band,) = (part for part in ax.collections if part.get_label() == "±5 %, settles in 0.215 s")
    box = band.get_datalim(ax.transData)
    assert (box.y0, box.y1) == pytest.approx((19, 21))
    assert box.x0 == pytest.approx(hybrid.events[0].t, abs=0.003)


def test_a_force_that_never_settles(proportional: arm3r.Run) -> None:
    ax = figure_of(proportional).axes[0]
    assert "±5 %, never settles" in legend(ax)
    assert not [line for line in ax.lines if len(set(line.get_xdata())) == 1 and len(line.get_xdata()) == 2]


def test_a_summary_without_metrics_has_no_settling(hybrid: arm3r.Run) -> None:
    figure = arm3r.plot.force(force_runs.changed(hybrid, {}, metrics={}), panels=["force"])
    assert not any("±" in text for text in legend(figure.axes[0]))


@pytest.mark.parametrize("label", PANELS)
def test_contact_is_shaded(bounce: arm3r.Run, label: str) -> None:
    ax = panel(figure_of(bounce), label)
    faces = [(part, part.get_facecolor()) for part in ax.collections]
    (shade,) = (part for part, face in faces if len(face) and same_color(face[0][:3], "#E69F00"))
    (path,) = shade.get_paths()
    assert (path.vertices[:, 0].min(), path.vertices[:, 0].max()) == pytest.approx(
        tuple(event.t for event in bounce.events)
    )


def test_many_contacts_are_one_artist(bounce: arm3r.Run) -> None:
    events = [force_runs.event(("make", "break")[i % 2], 0.1 + 1e-4 * i) for i in range(4000)]
    ax = arm3r.plot.force(force_runs.changed(bounce, {}, events=events), panels=["force"]).axes[0]
    (shade,) = (part for part in ax.collections if part.get_label() == "contact")
    assert len(shade.get_paths()) == 2000


def test_limits_are_drawn_in_their_joints_colours(hybrid: arm3r.Run) -> None:
    ax = panel(figure_of(hybrid), "torque, N m")
    drawn = lines(ax)
    levels = {line.get_ydata()[0]: line.get_color() for line in ax.lines if len(set(line.get_ydata())) == 1}
    for i, limit in zip("123", (20, 30, 25), strict=True):
        for level in (limit, -limit):
            assert same_color(levels[level], drawn[rf"$\tau_{i}$"].get_color())
    assert "limit ±20, ±30, ±25" in legend(ax)


@pytest.mark.parametrize(
    ("limits", "text", "drawn"),
    [
        ([None, None, None], None, set()),
        ([40, 40, 40], "limit ±40", {40, -40}),
        ([None, 40, 900], "limit none, ±40, ±900", {40, -40}),
        ([900, 900, 900], "limit ±900, far outside", set()),
    ],
)
def test_limits_of_every_kind(hybrid: arm3r.Run, limits: Any, text: str | None, drawn: set[float]) -> None:
    ax = panel(arm3r.plot.force(force_runs.changed(hybrid, {}, torque_limit=limits), panels=["torques"]), "torque, N m")
    assert [entry for entry in legend(ax) if "limit" in entry] == ([text] if text else [])
    assert {
        line.get_ydata()[0] for line in ax.lines if len(line.get_ydata()) == 2 and len(set(line.get_ydata())) == 1
    } == drawn


def test_saturation_is_marked(hybrid: arm3r.Run) -> None:
    marked = force_runs.changed(hybrid, {"saturated": (hybrid.t > 1) & (hybrid.t < 1.5)})
    ax = panel(arm3r.plot.force(marked, panels=["torques"]), "torque, N m")
    assert "at a limit" in legend(ax)
    assert "at a limit" not in legend(panel(figure_of(hybrid), "torque, N m"))


def test_the_first_contact_has_a_panel_where_it_is_short(hybrid: arm3r.Run) -> None:
    figure = figure_of(hybrid)
    ax = figure.axes[4]
    assert ax.get_xlabel() == "time since the first contact, ms"
    make, low, high = hybrid.events[0].t, *ax.get_xlim()
    assert low < make < make + hybrid.summary["metrics"]["settling_time"] < high < 1.5
    figure.draw_without_rendering()
    zero = [label for label in ax.get_xticklabels() if label.get_text() == "0"]
    assert zero[0].get_position()[0] == pytest.approx(make)
    brief = force_runs.hybrid(stop=0.8, every=1)
    assert not any("first contact" in ax.get_xlabel() for ax in arm3r.plot.force(brief).axes)


def test_a_peak_of_a_later_contact_is_not_marked_in_the_first(bounce: arm3r.Run) -> None:
    events = [force_runs.event(kind, t) for kind, t in (("make", 0.2), ("break", 0.21))]
    later = force_runs.changed(bounce, {}, events=[*events, *bounce.summary["events"]])
    figure = arm3r.plot.force(later)
    (ax,) = (ax for ax in figure.axes if "first contact" in ax.get_xlabel())
    assert not any("peak" in label for label in lines(ax))
    assert crowded(figure) == []


def test_the_path_on_the_face(hybrid: arm3r.Run) -> None:
    ax = panel(figure_of(hybrid), "along $e_2$, m")
    on = hybrid["contact"] > 0
    across = (hybrid["tip"] - hybrid["wall"]) @ np.stack([force_runs.E1, force_runs.E2], axis=1)
    path = lines(ax)["tip in contact"].get_xydata()
    assert path[on] == pytest.approx(across[on])
    assert np.isnan(path[~on]).all()
    assert lines(ax)["reference"].get_linestyle() == "--"
    assert ax.get_aspect() == 1
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    assert x0 < -0.15 and x1 > 0.05 and y0 < 0.03 and y1 > 0.23
    assert any("1 × 0.6 m" in other.get_title() for other in ax.figure.axes)


def test_a_large_path_is_drawn_on_the_whole_plate() -> None:
    ax = panel(arm3r.plot.force(force_runs.hybrid(circle=0.2)), "along $e_2$, m")
    box = next(patch for patch in ax.patches if patch.get_label() == "plate").get_bbox()
    assert box.extents.tolist() == pytest.approx([-0.5, -0.3, 0.5, 0.3])
    assert ax.get_xlim()[0] < -0.5 and ax.get_xlim()[1] > 0.5


def test_a_point_is_drawn_in_millimetres(bounce: arm3r.Run) -> None:
    ax = panel(arm3r.plot.force(bounce, panels=["face"]), "along $e_2$, mm")
    assert lines(ax)["reference"].get_xydata().tolist() == [pytest.approx([50, 130])]


def test_a_run_without_force_control(pushed: arm3r.Run) -> None:
    figure = figure_of(pushed)
    assert "reference" not in legend(figure.axes[0])
    force = lines(figure.axes[0])["force"].get_ydata()  # and not "true": nothing is measured
    assert force.max() == pytest.approx(np.linalg.norm(pushed["f_on_wall"], axis=1).max())


def test_a_partial_run(hybrid: arm3r.Run) -> None:
    few = {name: hybrid[name][:3] for name in hybrid.columns}
    run = arm3r.Run(few, hybrid.units, {**hybrid.summary, "events": [], "peak_force": 0.0, "metrics": {}}, None)
    assert labels(arm3r.plot.force(run))[0] == PANELS[0]
    arm3r.plot.force(arm3r.Run({n: c[:1] for n, c in few.items()}, hybrid.units, run.summary, None))


def test_what_cannot_be_drawn_is_said(fall: arm3r.Run, hybrid: arm3r.Run) -> None:
    with pytest.raises(arm3r.UsageError, match="fall: no column force, and the run has no wall"):
        arm3r.plot.force(fall)
    with pytest.raises(arm3r.UsageError, match="no scenario"):
        arm3r.plot.force(force_runs.without(hybrid, "force", scenario=None))
    with pytest.raises(arm3r.UsageError, match="no column tau"):
        arm3r.plot.force(force_runs.without(hybrid, "tau"))


# ---- as a reader sees it --------------------------------------------------------------------------------------------


@pytest.mark.sample(3)
@pytest.mark.parametrize("width", [6.3, 3.4])
@pytest.mark.parametrize("which", ["hybrid", "bounce", "proportional", "pushed"])
def test_nothing_is_cut_off_or_hidden(which: str, width: float, request: pytest.FixtureRequest) -> None:
    assert crowded(arm3r.plot.force(request.getfixturevalue(which), width=width)) == []


@pytest.mark.parametrize("width", [6.3, 3.4])
@pytest.mark.parametrize("count", [2, 6])
def test_nothing_is_cut_off_or_hidden_in_a_comparison(
    hybrid: arm3r.Run, proportional: arm3r.Run, width: float, count: int
) -> None:
    names = [f"a_rather_long_name_of_a_controller_{i}" for i in range(count)]
    runs = dict(zip(names, [hybrid, proportional] * 3, strict=False))
    assert crowded(arm3r.plot.compare(runs, width=width)) == []


@pytest.mark.sample(1)
@pytest.mark.parametrize("which", ["hybrid", "bounce", "pushed"])
def test_in_a_column_no_legend_takes_half_a_panel(which: str, request: pytest.FixtureRequest) -> None:
    run = request.getfixturevalue(which)
    four = {f"a_rather_long_name_{i}": run for i in range(4)}
    drawn = [arm3r.plot.force(run, width=3.4), arm3r.plot.overview(run, width=3.4), arm3r.plot.compare(four, width=3.4)]
    for figure in drawn:
        figure.draw_without_rendering()
        for ax in (ax for ax in figure.axes if ax.get_legend()):
            assert ax.get_legend().get_window_extent().height < 0.5 * max(ax.bbox.height, figure.dpi), ax.get_ylabel()


def test_an_entry_of_words_takes_no_place_for_a_line(hybrid: arm3r.Run) -> None:
    figure = arm3r.plot.force(hybrid, panels=["path_error"])
    figure.draw_without_rendering()
    entries = [text.get_window_extent() for text in figure.axes[0].get_legend().get_texts()]
    gaps = [other.x0 - one.x1 for one, other in pairwise(entries)]
    assert gaps[-1] < 0.5 * gaps[0]


def test_drawing_changes_no_settings(hybrid: arm3r.Run) -> None:
    before = dict(rcParams)
    arm3r.plot.compare([hybrid, hybrid])
    assert dict(rcParams) == before


# ---- comparison -----------------------------------------------------------------------------------------------------


def test_a_comparison_overlays_runs_by_name(hybrid: arm3r.Run, proportional: arm3r.Run) -> None:
    figure = arm3r.plot.compare([hybrid, proportional])
    assert legend(figure.axes[0]) == ["hybrid", "without integral", "reference"]
    assert [label.replace("\n", " ") for label in labels(figure)][:6] == [
        "pressing force, N", "force error, N", "path error, mm", *(rf"$\tau_{i}$, N m" for i in "123"),
    ]  # fmt: skip
    for ax, run_of in ((figure.axes[3], "tau1"), (figure.axes[5], "tau3")):
        for line, run in zip(ax.lines, (hybrid, proportional), strict=True):
            assert line.get_ydata().tolist() == run[run_of].tolist()
    colours = [line.get_color() for line in figure.axes[3].lines]
    assert len(set(colours)) == 2
    face = next(ax for ax in figure.axes if "e_2" in ax.get_ylabel())
    assert {line.get_color() for line in face.lines} >= set(colours)


def test_first_contacts_are_drawn_over_each_other(hybrid: arm3r.Run) -> None:
    """One begins a second later: its curve is the same, counted from its own contact."""
    event = hybrid.summary["events"][0]
    later = force_runs.changed(hybrid, {"t": hybrid.t + 1}, events=[{**event, "t": event["t"] + 1}])
    ax = arm3r.plot.compare({"one": hybrid, "later": later}, panels=["first_contact"]).axes[0]
    one, other = (line.get_xydata() for line in ax.lines[:2])
    assert one == pytest.approx(other)
    assert one[np.flatnonzero(one[:, 1] > 0)[0] - 1, 0] == pytest.approx(0)
    assert ax.get_xlim()[0] < 0 < ax.get_xlim()[1] < 1


def test_errors_of_a_comparison(hybrid: arm3r.Run, proportional: arm3r.Run) -> None:
    figure = arm3r.plot.compare([hybrid, proportional])
    errors = [line.get_ydata()[-1] for line in figure.axes[1].lines]
    assert errors == pytest.approx([0, 7], abs=1e-3)  # b v / kP more, without an integral
    off = hybrid["tip"] - hybrid["tip_ref"]
    along = np.linalg.norm(off @ np.stack([force_runs.E1, force_runs.E2], 1), axis=1)
    distance = np.where(hybrid["force_phase"] > 0, along, np.linalg.norm(off, axis=1))  # as tip_path_error_max has it
    assert figure.axes[2].lines[0].get_ydata() == pytest.approx(1e3 * distance, abs=1e-9)


def test_the_table_of_a_comparison(hybrid: arm3r.Run, proportional: arm3r.Run) -> None:
    texts = [text.get_text() for text in arm3r.plot.compare([hybrid, proportional]).axes[-1].texts]
    rows = [texts[i] for i in range(texts.index("hybrid"))]
    assert rows[:4] == ["peak force, N", "overshoot, N", "force error rms, N", "settling time, s"]
    found = hybrid.summary["metrics"]
    first = texts[
        texts.index("hybrid") + 1 : texts.index(
            "without\nintegral" if "without\nintegral" in texts else "without integral"
        )
    ]
    assert float(first[0]) == pytest.approx(found["peak_force"], rel=5e-3)
    assert float(first[rows.index("path error max, mm")]) == pytest.approx(1e3 * found["tip_path_error_max"], rel=5e-3)
    assert first[rows.index("contacts")] == "1"
    assert "never" in texts


def test_numbers_of_the_table_that_are_whole_or_missing(hybrid: arm3r.Run) -> None:
    """As JSON gives them: 1 for 1.0, null for what does not apply."""
    whole = force_runs.changed(hybrid, {}, metrics={"peak_force": 20, "saturation_share": 1, "settling_time": None})
    free = force_runs.without(whole, "force_ref", "force_phase")
    texts = [text.get_text() for text in arm3r.plot.compare({"wanted": whole, "not": free}).axes[-1].texts]
    rows, first, second = texts[:3], texts[texts.index("wanted") + 1 :][:3], texts[texts.index("not") + 1 :]
    assert rows == ["peak force, N", "settling time, s", "saturated, %"]
    assert first == ["20.0", "never", "100"]
    assert second == ["20.0", "–", "100"]


def test_rounding_is_no_error_in_the_table(hybrid: arm3r.Run) -> None:
    exact = force_runs.changed(hybrid, {}, metrics={"tip_path_error_rms": 2e-16, "tip_path_error_max": 2e-3})
    texts = [text.get_text() for text in arm3r.plot.compare({"one": exact, "two": exact}).axes[-1].texts]
    assert texts[-2:] == ["0", "2.00"]


def test_references_that_differ_are_each_drawn(hybrid: arm3r.Run) -> None:
    other = force_runs.changed(hybrid, {"force_ref": 15 + 0 * hybrid.t})
    ax = arm3r.plot.compare({"20": hybrid, "15": other}).axes[0]
    assert legend(ax)[-1] == "references"
    assert {15.0, 20.0} <= {line.get_ydata()[0] for line in ax.lines if len(line.get_ydata())}


def test_runs_with_and_without_force_control_compare(hybrid: arm3r.Run) -> None:
    figure = arm3r.plot.compare({"hybrid": hybrid, "stiffness": force_runs.without(hybrid, "force_ref", "force_phase")})
    assert len(figure.axes[0].lines) == 3
    assert len(figure.axes[1].lines) == 1
    one, other = (line.get_ydata() for line in figure.axes[2].lines)
    controlled = hybrid["force_phase"] > 0  # there the normal direction counts for the second run alone
    assert one[~controlled] == pytest.approx(other[~controlled])
    assert np.hypot(one, 1e3 * hybrid["depth"])[controlled] == pytest.approx(other[controlled])


def test_runs_that_do_not_compare(hybrid: arm3r.Run, pushed: arm3r.Run) -> None:
    with pytest.raises(arm3r.UsageError, match=r"scenario: wall.normal is .*, that of hybrid is .* one wall"):
        arm3r.plot.compare([hybrid, pushed])
    for runs in ([hybrid], [hybrid] * 7):
        with pytest.raises(arm3r.UsageError, match=f"2 to 6 runs fit into one figure, got {len(runs)}"):
            arm3r.plot.compare(runs)


@pytest.mark.parametrize("most", range(3, 12))
def test_long_names_lose_their_middle(most: int) -> None:
    short = shortened("abcdefghijkl", most)
    assert len(short) == most
    assert short[0] == "a" and short[-1] == "l"
    assert shortened("abc", 3) == "abc"


# ---- what is drawn, and how large -----------------------------------------------------------------------------------


def test_panels_are_those_asked_for_in_their_order(hybrid: arm3r.Run) -> None:
    assert labels(arm3r.plot.force(hybrid, panels=["torques", "face", "force"])) == [PANELS[2], PANELS[0], BELOW[1]]
    assert labels(arm3r.plot.overview(hybrid, panels=["depth", "angles"])) == ["depth, mm", "joint angle, rad"]
    assert len(labels(arm3r.plot.compare([hybrid, hybrid], panels=["contact", "face"]))) == 2


def test_what_a_run_cannot_show_is_no_panel(fall: arm3r.Run) -> None:
    with pytest.raises(arm3r.UsageError, match=r"tank: the run has nothing .* this figure can have angles, tip"):
        arm3r.plot.overview(fall, panels=["tank"])


@pytest.mark.parametrize("height", [5.5, 12.0])
def test_a_figure_is_as_high_as_asked(hybrid: arm3r.Run, height: float) -> None:
    figure = arm3r.plot.force(hybrid, height=height, panels=["force", "torques", "face"], stamp=True)
    assert figure.get_size_inches().tolist() == pytest.approx([6.3, height])
    assert crowded(figure) == []


def test_a_figure_of_a_column_fits_a_page(hybrid: arm3r.Run, proportional: arm3r.Run, pushed: arm3r.Run) -> None:
    figures = [arm3r.plot.force(hybrid, width=3.4), arm3r.plot.overview(pushed, width=3.4)]
    figures += [arm3r.plot.compare([hybrid, proportional], width=3.4, stamp=True)]
    for figure in figures:
        assert figure.get_figheight() <= 9.0 + 1e-9
        assert crowded(figure) == []


def test_a_part_of_a_run(hybrid: arm3r.Run) -> None:
    figure = arm3r.plot.force(hybrid, start=1.0, end=2.5)
    drawn_force = lines(figure.axes[0])["true"]
    assert figure.axes[0].get_xlim() == pytest.approx((1, 2.5))
    assert drawn_force.get_xdata().tolist() == hybrid.t[(hybrid.t >= 1) & (hybrid.t <= 2.5)].tolist()
    assert not any("settles" in text for text in legend(figure.axes[0]))  # that was before
    (shade,) = (part for part in figure.axes[0].collections if part.get_label() == "contact")
    assert shade.get_paths()[0].vertices[:, 0].min() == pytest.approx(1)  # it goes on since 0.4 s


def test_the_peak_of_a_part_is_its_own(hybrid: arm3r.Run) -> None:
    later = hybrid["force"][hybrid.t >= 0.6].max()
    (label,) = (text for text in legend(arm3r.plot.force(hybrid, start=0.6).axes[0]) if "peak" in text)
    assert label.startswith(f"peak {later:.4g} N")
    (label,) = (text for text in legend(arm3r.plot.force(hybrid, end=0.6).axes[0]) if "peak" in text)
    assert label.startswith(f"peak {hybrid.summary['peak_force']:.4g} N")


@pytest.mark.parametrize("convention", ["simscape", "slide"])
@pytest.mark.parametrize("width", [3.4, 6.3])
def test_a_stamp_says_where_the_numbers_come_from(convention: str, width: float) -> None:
    run = arm3r.Scenario(f"{{format: 1, name: fall, arm: {{convention: {convention}}}, time: {{stop: 0.1}}}}").run()
    plain, stamped = (arm3r.plot.overview(run, width=width, panels=["tip"], stamp=stamp) for stamp in (False, True))
    (text,) = (text.get_text() for text in stamped.texts)
    wanted = ["scenario fall", f"convention {convention}", f"hash {run.summary['hash']}"]
    assert text.replace("\n", ", ").split(", ") == wanted
    assert not plain.texts
    assert crowded(stamped) == []


def test_a_comparison_is_stamped_with_all_runs(hybrid: arm3r.Run, proportional: arm3r.Run) -> None:
    (text,) = arm3r.plot.compare([hybrid, proportional], panels=["table"], stamp=True).texts
    assert hybrid.summary["hash"] in text.get_text() and proportional.summary["hash"] in text.get_text()


# ---- arm3r-plot -----------------------------------------------------------------------------------------------------


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory, pushed: arm3r.Run, fall: arm3r.Run) -> Path:
    """hybrid.csv; p.csv, other gains; same.csv, called as hybrid.csv; pushed.csv without force control; fall.csv."""
    folder = tmp_path_factory.mktemp("runs")
    hybrid = force_runs.hybrid(every=50)
    force_runs.stored(hybrid, folder / "hybrid.csv")
    force_runs.stored(hybrid, folder / "same.csv")
    force_runs.stored(force_runs.hybrid(name="without integral", ki=0.0, every=50), folder / "p.csv")
    pushed.to_csv(folder / "pushed.csv")
    fall.to_csv(folder / "fall.csv")
    return folder


@pytest.fixture
def files(here: Path, stored: Path) -> Path:
    """A folder of its own for each test, with the stored runs."""
    shutil.copytree(stored, here, dirs_exist_ok=True)
    return here


def drawn(path: Path) -> str:
    """An SVG with its words."""
    return path.read_text()


def test_force_control_is_drawn_by_itself(files: Path) -> None:
    assert plot_cli.main(["hybrid.csv", "--format", "svg"]) == 0
    assert "<!-- pressing force, N -->" in drawn(files / "hybrid.svg")
    assert plot_cli.main(["hybrid.csv", "--overview", "-o", "overview.svg"]) == 0
    assert "<!-- pressing force, N -->" not in drawn(files / "overview.svg")
    assert plot_cli.main(["pushed.csv", "-o", "pushed.svg"]) == 0
    assert "<!-- pressing force, N -->" not in drawn(files / "pushed.svg")


def test_force_on_request(files: Path) -> None:
    assert plot_cli.main(["pushed.csv", "--force", "-o", "force.svg", "--width", "3.4"]) == 0
    assert "<!-- pressing force, N -->" in drawn(files / "force.svg")
    assert f'width="{3.4 * 72:g}pt"' in drawn(files / "force.svg")


def test_compare_from_files(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert plot_cli.main(["--compare", "hybrid.csv", "p.csv", "-o", "new/folder", "--panels", "table"]) == 0
    assert capsys.readouterr().out == "new/folder/compare.png\n"
    assert plot_cli.main(["hybrid.csv", "--compare", "p.csv", "-o", "two.svg", "--panels", "force"]) == 0
    assert "<!-- without integral -->" in drawn(files / "two.svg")


def test_runs_of_one_name_are_called_as_their_files(files: Path) -> None:
    assert plot_cli.main(["--compare", "hybrid.csv", "same.csv", "-o", "two.svg", "--panels", "force"]) == 0
    assert "<!-- same -->" in drawn(files / "two.svg")
    (files / "other").mkdir()
    force_runs.stored(arm3r.Run.load("hybrid.csv"), files / "other" / "hybrid.csv")
    assert plot_cli.main(["--compare", "hybrid.csv", "other/hybrid.csv", "-o", "two.svg", "--panels", "force"]) == 0
    assert "<!-- other/hybrid -->" in drawn(files / "two.svg")


@pytest.mark.sample(1)
@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_the_same_run_is_the_same_bytes(files: Path, suffix: str) -> None:
    for name in ("one", "two"):
        assert plot_cli.main(["hybrid.csv", "-o", f"{name}.{suffix}", "--panels", "force,face", "--stamp"]) == 0
    assert (files / f"one.{suffix}").read_bytes() == (files / f"two.{suffix}").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "RUN.csv"),
        (["fall.csv", "--force"], "no column force"),
        (["--compare", "hybrid.csv"], "2 to 6 runs"),
        (["--compare", "hybrid.csv", "fall.csv"], "fall: no column force"),
        (["--compare", "hybrid.csv", "pushed.csv"], "wall.normal"),
        (["--compare", "hybrid.csv", "hybrid.csv"], "given twice"),
        (["--compare", "hybrid.csv", "missing.csv"], "missing.csv"),
        (["--compare", "hybrid.csv", "damaged.csv"], "damaged.csv:3"),
        (["hybrid.csv", "--lecture", "--width", "4"], "--width"),
        (["--compare", "hybrid.csv", "p.csv", "-o", "x.jpg"], "png, pdf, svg"),
        (["hybrid.csv", "--lecture", "--height", "4"], "--height"),
        (["hybrid.csv", "--panels", "torque"], "panels: torque: there is no such panel; did you mean torques?"),
        (
            ["hybrid.csv", "--panels", "tank"],
            "panels: tank: the run has nothing to show there; this figure can have ",
        ),
        (["hybrid.csv", "--lecture", "--panels", "tank"], "there are tip, velocities"),
        (["hybrid.csv", "--height", "3"], "height: 3 inches are too few"),
        (
            ["hybrid.csv", "--from", "3", "--to", "2"],
            "from 3 s to 2 s: there are 0 rows, and 2 are needed",
        ),
        (["hybrid.csv", "--from", "9"], "0 rows"),
    ],
)
def test_failures_say_why_and_write_nothing(
    arguments: list[str], words: str, files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (files / "hybrid.csv").read_text().splitlines(keepends=True)
    (files / "damaged.csv").write_text("".join([*text[:2], text[2].replace(",", ",x", 1), *text[3:]]))
    before = set(files.rglob("*"))
    assert plot_cli.main(arguments) == 2
    said = capsys.readouterr()
    assert said.err.startswith("arm3r-plot: ")
    assert words in said.err
    assert said.out == ""
    assert set(files.rglob("*")) == before


@pytest.mark.parametrize(
    "arguments",
    [
        ["--height", "0.5"],
        ["--from", "soon"],
        ["--width", "2"],
        ["--width", "wide"],
        ["--force", "--lecture"],
        ["--compare"],
    ],
)
def test_options_that_cannot_be(arguments: list[str], files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        plot_cli.main(["hybrid.csv", *arguments])
    assert ended.value.code == 2
    assert arguments[0] in capsys.readouterr().err


def test_figures_are_written_all_or_none(files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (files / "figures").mkdir()
    old = files / "figures" / "pushed_tip.png"
    old.write_text("old")
    savefig, calls = Figure.savefig, iter(range(100))

    def failing(figure: Figure, *arguments: Any, **options: Any) -> None:
        if next(calls) == 2:
            raise OSError(28, "No space left on device")
        savefig(figure, *arguments, **options)

    monkeypatch.setattr(Figure, "savefig", failing)
    assert plot_cli.main(["pushed.csv", "--lecture", "-o", "figures", "--panels", "torques,tip,contact"]) == 6
    assert [path.name for path in (files / "figures").iterdir()] == [old.name]
    assert old.read_text() == "old"
