"""Writes docs/scenarios.md and its pictures: every scenario of the repository in a line, with its motion and a curve.

    python tools/scenario_index.py              all of them; the package must be installed
    python tools/scenario_index.py plate_edge   the page, and the pictures of these scenarios only

The line is the first sentence of the comment at the head of a file. The left part of a picture shows the arm and the
wall from the side, darker is later; the right part shows what the scenario is about.
"""

from __future__ import annotations

import io
import sys
import textwrap
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
from arm3r_cpp.examples import summary
from arm3r_cpp.plot.strobe import flash_rows
from arm3r_cpp.plot.style import ARM, BLACK, MEASURED, ON_WALL, REFERENCE, TRIPLE, WALL, angle_unit, style

DOCS = Path(__file__).parents[1] / "docs"
SCENARIOS = DOCS.parent / "scenarios"
PAGE = DOCS / "scenarios.md"
PICTURES = DOCS / "images" / "scenarios"

TITLES = {
    "scenarios": "First scenarios",
    "lecture": "The demonstrations of the lecture",
    "contact": "Contact",
    "joint_control": "Joint control",
    "impedance": "Stiffness, impedance and admittance",
    "force_control": "Force control",
    "collision": "Momentum observer and collisions",
    "sampled_control": "Sampled control and sensors",
    "passivity": "Passivity",
    "sweeps": "Sweeps",
}
HEAD = """\
# Scenarios

Every installed scenario, with a line and a picture. `arm3r examples` lists them,
`arm3r examples NAME` prints one, and `arm3r examples --copy DIR` copies all of them. In a picture,
the left part shows the arm and the wall from the side, darker at later times; the right part shows
quantities over time, with references dashed. The comment at the head of a file says more: where its
numbers come from, and which equation of [the model](model.md) it shows.

This page and its pictures are written by `tools/scenario_index.py`.
"""
TIP_ERROR = {"tip_x - tip_ref_x": "tip error x, m"}
JOINT_ERRORS = {f"q{i} - q_ref{i}": "joint errors, rad" for i in (1, 2, 3)}
RESIDUALS = {f"residual{i}": "residual, N m" for i in (1, 2, 3)}
TORQUES = {f"tau{i}": "torque, N m" for i in (1, 2, 3)}
ANGLES = {f"q{i}": "angle, rad" for i in (1, 2, 3)}
WALL_FORCE = {"f_on_wall_x": "force on the wall, N"}
CURVES: dict[str, dict[str, str]] = {
    "admittance_stability_limit": TIP_ERROR,
    "computed_torque": JOINT_ERRORS,
    "computed_torque_push": JOINT_ERRORS,
    "energy_balance": {
        "work_actuators": "energy, J", "work_wall": "energy, J", "energy_dissipated": "energy, J",
    },
    "hybrid_biased_sensor": {"force": "force, N", "force_measured": "force, N"},
    "hybrid_kinematic_instability": TIP_ERROR,
    "joint_pd_sag": {"tip_z": "tip height, m"},
    "observer_force_ramp": RESIDUALS,
    "observer_force_step": RESIDUALS,
    "observer_moving_wall": RESIDUALS,
    "observer_sampled": RESIDUALS,
    "parallel_fixed_wall": {"tip_y": "tip, m", "tip_z": "tip, m"},
    "reflex_apparent_mass": {"tip_vx": "tip speed, m/s"},
    "restitution": {"tip_vx": "tip speed, m/s"},
    "sampled_with_sensors": {"force_measured": "force, N", "force": "force, N"},
    "sampling_period_stable": {"q1 - q_ref1": "error of q1, rad"},
    "sampling_period_unstable": {"q1 - q_ref1": "error of q1, rad"},
    "variable_stiffness_no_tank": {"energy_kinetic": "kinetic energy, J"},
    "variable_stiffness_tank": {"tank_energy": "energy, J", "energy_kinetic": "energy, J"},
    "virtual_wall": {"energy_kinetic": "kinetic energy, J"},
    "virtual_wall_passive": {"energy_kinetic": "kinetic energy, J"},
    "wall_stiffness_estimate": {"stiffness_estimate": "stiffness, N/m"},
    "wall_stiffness_not_identifiable": {"stiffness_estimate": "stiffness, N/m"},
    "01_hold_pose_a": TORQUES,
    "02_hold_pose_a_recursion": TORQUES,
    "03_hold_pose_b": TORQUES,
    "04_hold_pose_b_recursion": TORQUES,
    "06_jacobian_by_three_velocities": {"tip_vz": "tip speed, m/s", "tip_jvz": "tip speed, m/s"},
    "09_wall_alone": {"depth": "depth, m"},
    "13_unequal_hold": TORQUES,
    "14_unequal_fall": {"tip_vy": "tip speed, m/s", "tip_jvy": "tip speed, m/s"},
}  # fmt: skip
"""What is drawn where it is not the force of a controller, the force on the wall, or the joint angles."""
COLOURS = {"force": ON_WALL, "f_on_wall_x": ON_WALL, "force_measured": MEASURED}
WINDOWS = {
    "05_free_fall": (0, 3), "06_jacobian_by_three_velocities": (0, 3), "07_partial_compensation": (0, 3),
    "08_moon": (0, 6), "12_wall_acts_on_arm": (5.3, 5.5), "hybrid_first_contact": (5.2, 6.4),
    "hybrid_moving_wall": (0, 0.5), "hybrid_rotated": (0, 0.5), "hybrid_jacobian_transpose": (0, 0.5),
    "parallel_moving_wall": (0, 1), "restitution": (5.356, 5.37), "stiff_damping": (0, 1e-4),
    "stiff_wall": (5.3585, 5.362), "unequal_arm": (0, 0.3), "variable_stiffness_no_tank": (1, 2),
    "hybrid_biased_sensor": (0, 1), "shaped_impedance_step": (0, 1), "impedance_step": (0, 1),
    "stiffness_fixed_wall": (0, 1), "joint_stiffness_fixed_wall": (0, 1), "joint_pd_sag": (0, 3),
    "adaptive_reference_moving_wall": (0, 2), "wall_stiffness_underestimated": (0, 0.5),
    "wall_stiffness_overestimated": (0, 0.5), "reaction_float": (0, 0.3), "reaction_reflex": (0, 0.3),
    "reaction_retreat": (0, 1.05),
}  # fmt: skip
"""s: the part of a run that is drawn, where it is not all of it."""


def files() -> list[Path]:
    """Every scenario and sweep, in the order of the page."""
    order = list(TITLES)
    return sorted(SCENARIOS.rglob("*.yaml"), key=lambda path: (order.index(path.parent.name), path.stem))


def page() -> str:
    """The text of docs/scenarios.md."""
    parts, topic = [HEAD], ""
    for path in files():
        if topic != path.parent.name:
            topic = path.parent.name
            parts.append(f"\n## {TITLES[topic]}\n")
        name = path.relative_to(SCENARIOS).as_posix()
        parts.append("\n" + textwrap.fill(f"[`{name}`](../scenarios/{name}): {summary(path)}", 100,
                                          break_long_words=False, break_on_hyphens=False) + "\n")  # fmt: skip
        if topic != "sweeps":
            parts.append(f"\n![{alternative_text(path)}]({picture_of(path).relative_to(DOCS).as_posix()})\n")
    return "".join(parts)


def picture_of(path: Path) -> Path:
    return PICTURES / f"{path.stem}.png"


def alternative_text(path: Path) -> str:
    return f"{path.stem}: the arm, the wall and a curve over time"


def run_of(path: Path) -> tuple[arm3r.Run, tuple[float, float]]:
    """The run, with 400 rows in the part that is drawn, and that part."""
    scenario = arm3r.Scenario.load(path)
    part = WINDOWS.get(path.stem, (scenario["time.start"], scenario["time.stop"]))
    scenario["checks"] = []
    if path.stem in WINDOWS:
        scenario.update({"time.stop": part[1], "time.log_every": (part[1] - part[0]) / 400})
    return scenario.run(), part


def curves_of(name: str, run: arm3r.Run) -> dict[str, str]:
    """Each column that is drawn, or difference of two, with the label of its axis."""
    if name in CURVES:
        return CURVES[name]
    if "force" in run:
        return {"force": "force, N"}
    return WALL_FORCE if np.any(run["f_on_wall"]) else ANGLES


def values_of(run: arm3r.Run, curve: str) -> Any:
    first, _, second = curve.partition(" - ")
    return run[first] - run[second] if second else run[first]


def draw_curves(ax: Any, run: arm3r.Run, part: tuple[float, float], curves: dict[str, str]) -> None:
    rows = np.flatnonzero((run.t >= part[0]) & (run.t <= part[1]))
    rows = rows[:: max(1, len(rows) // 2000)]
    label, unit = next(iter(curves.values())), angle_unit(arm3r.Scenario(run.summary["scenario"]))
    quantity, _, its_unit = label.rpartition(", ")
    factor, label = (unit.factor, f"{quantity}, {unit.name}") if its_unit == "rad" else (1.0, label)
    for curve, look in zip(curves, TRIPLE, strict=False):
        look = {**look, "color": COLOURS.get(curve, look["color"])}
        ax.plot(run.t[rows], factor * values_of(run, curve)[rows], **look, label=curve)
    if "force" in curves and "force_ref" in run:
        ax.plot(run.t[rows], run["force_ref"][rows], color=REFERENCE, ls="--", lw=0.8)
    if len(curves) > 1:
        ax.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    ax.set(xlabel="t, s", ylabel=label, xlim=part)
    ax.locator_params(axis="x", nbins=5)
    ax.locator_params(axis="y", nbins=4)


def draw_arm(ax: Any, run: arm3r.Run) -> None:
    """From the side: along the horizontal direction in which the arm points at first, and upwards."""
    scenario = arm3r.Scenario(run.summary["scenario"])
    base = np.array([0, 0, scenario["arm.base_height"]])
    reach = scenario["arm.link2.length"] + scenario["arm.link3.length"]
    shown = np.union1d(0, flash_rows(run["tip"], reach))
    q1 = run["q1"][0]
    view = np.array([[np.cos(q1), np.sin(q1), 0], [0, 0, 1]])
    elbow = scenario.arm.elbow_position(run["q"][shown])
    for k, row in enumerate(shown):
        points = view @ np.stack([base, elbow[k], run["tip"][row]], axis=1)
        ax.plot(*points, color=ARM, lw=2, alpha=0.15 + 0.85 * (k + 1) / len(shown), solid_capstyle="round",
                clip_on=False)  # fmt: skip
    if "wall_x" in run.columns and abs(scenario["wall.normal"][2]) < 0.5:
        size = scenario["wall.size"]
        half = 0.5 if isinstance(size, str) else size[1] / 2
        for row, alpha in ((shown[0], 0.3), (shown[-1], 1.0)):
            across, up = view @ run["wall"][row]
            ax.plot([across, across], [up - half, up + half], color=WALL, lw=1.6, alpha=alpha)
    ax.plot(*(view @ base), "o", color=BLACK, ms=4, clip_on=False)
    ax.set_aspect("equal")
    ax.set_axis_off()


def draw(path: Path) -> bytes:
    """The picture as PNG."""
    from matplotlib.figure import Figure
    from PIL import Image

    run, part = run_of(path)
    with style():
        import matplotlib

        matplotlib.rcParams.update({"font.size": 7, "axes.labelsize": 7, "legend.fontsize": 6.5})
        figure = Figure(figsize=(4.6, 1.35), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=(1, 2.2))
        draw_arm(left, run)
        draw_curves(right, run, part, curves_of(path.stem, run))
        drawn, small = io.BytesIO(), io.BytesIO()
        figure.savefig(drawn, dpi=120, format="png")
    Image.open(drawn).convert("RGB").quantize(64).save(small, "PNG", optimize=True)
    return small.getvalue()


def main(names: list[str]) -> None:
    PAGE.write_text(page())
    PICTURES.mkdir(parents=True, exist_ok=True)
    wanted = [path for path in files() if path.parent.name != "sweeps"]
    for path in PICTURES.glob("*.png"):
        if path not in map(picture_of, wanted):
            path.unlink()
    for path in wanted:
        if not names or path.stem in names:
            picture_of(path).write_bytes(draw(path))


if __name__ == "__main__":
    main(sys.argv[1:])
