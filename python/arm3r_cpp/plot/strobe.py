"""The arm and the wall in space: a strobe picture with joint axes, positive directions and both contact forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.arm_line import arm_line, base_axes, heading
from .force_run import ForceRun
from .style import ARM, BLACK, ON_TIP, ON_WALL, TIP, TRIPLE, WALL
from .wall_frame import half_sides, wall_frame

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..core.run import Run
    from .run_figure import RunFigure

FLASHES = 7
PATH_IN_REACHES = 3.0  # the strobe stops when the tip has come this far: a swinging arm would paint over itself


def strobe(run: Run, _: float) -> RunFigure:
    from ..core.scenario import Scenario
    from .run_figure import RunFigure

    scenario = Scenario(run.summary["scenario"])
    arm, q, tip = scenario.arm, run["q"], run["tip"]
    reach = arm.reach
    flashes = flash_rows(tip, reach)
    lines, joints = arm_line(arm, q[flashes])
    last = lines[-1]

    figure = RunFigure(figsize=(6.3, 4.9))
    ax: Any = figure.add_axes((0, -0.02, 0.97, 0.97), projection="3d", computed_zorder=False)
    times = run.t[flashes]
    moment = f"{times[0]:.4g} to {times[-1]:.4g} s, darker is later" if len(flashes) > 1 else f"{times[0]:.4g} s"
    ax.plot([], [], color=ARM, lw=4, solid_capstyle="round", label=f"arm at {moment}")
    ground(ax, last[0], base_axes(scenario), reach)
    if "depth" in run.units:
        draw_walls(ax, run, scenario, reach)
    if len(flashes) > 1:
        ax.plot(*tip[: flashes[-1] + 1].T, color=TIP, lw=1.0, zorder=3, label="path of the tip")
    for k, points in enumerate(lines):
        draw_arm(ax, points, joints, alpha=0.15 + 0.85 * (k + 1) / len(flashes))
    draw_joint_axes(ax, arm.geometric_jacobian(q[flashes[-1]])[3:].T, last[[0, *joints]], reach)
    draw_forces(ax, run, tip, reach)
    fit(ax, heading(scenario, q[flashes[-1]]))
    figure.legend(loc="upper left", bbox_to_anchor=(0.02, 0.99))
    return figure


def flash_rows(tip: NDArray[np.float64], reach: float) -> NDArray[np.intp]:
    """Rows to show, evenly spaced; just the last one when the arm stays where it is."""
    path = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(tip, axis=0), axis=1))])
    if path[-1] < 1e-3 * reach:
        return np.array([len(tip) - 1])
    last = min(int(np.searchsorted(path, PATH_IN_REACHES * reach)), len(tip) - 1)
    return np.unique(np.linspace(0, last, FLASHES).round().astype(int))


def ground(ax: Any, top: NDArray[np.float64], axes: NDArray[np.float64], reach: float) -> None:
    """A column along axis 1, which ends where the arm begins, on a disc."""
    foot = top - 0.25 * reach * axes[:, 2]
    ax.plot(*np.stack([foot, top]).T, color="#777777", lw=7, solid_capstyle="butt", zorder=2)
    angle = np.linspace(0, 2 * np.pi, 60)
    disc = foot + 0.12 * reach * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1) @ axes.T
    ax.plot(*disc.T, color="#777777", lw=1.5, zorder=2)


def draw_arm(ax: Any, points: Any, joints: list[int], *, alpha: float) -> None:
    ax.plot(*points.T, color=ARM, lw=4, alpha=alpha, solid_capstyle="round", solid_joinstyle="round", zorder=4)
    ax.plot(*points[joints].T, color=BLACK, ls="", marker="o", ms=5, alpha=alpha, zorder=5)
    ax.plot(*points[-1:].T, color=TIP, ls="", marker="o", ms=4, alpha=alpha, zorder=5)


def draw_joint_axes(ax: Any, axes: Any, origins: Any, reach: float) -> None:
    """Each axis as an arrow, and around it an open circle that turns the positive way."""
    from matplotlib.patheffects import withStroke

    for i, (axis, origin) in enumerate(zip(axes, origins, strict=True), start=1):
        end, colour = origin + 0.34 * reach * axis, TRIPLE[i - 1]["color"]
        arrow(ax, origin, end, colour, 1.4)
        name = ax.text(*(end + 0.06 * reach * axis), f"$q_{i}$", color=colour, ha="center", va="center", zorder=9)
        name.set_path_effects([withStroke(linewidth=3, foreground="white")])
        side = np.cross(axis, [0, 1, 0] if abs(axis[1]) < 0.9 else [0, 0, 1])
        side *= 0.07 * reach / np.linalg.norm(side)
        angle = np.linspace(0, 1.5 * np.pi, 40)[:, None]
        circle = origin + 0.22 * reach * axis + np.cos(angle) * side + np.sin(angle) * np.cross(axis, side)
        ax.plot(*circle.T, color=colour, lw=1.4, zorder=6)
        arrow(ax, circle[-3], circle[-1], colour, 1.4, head=2.0)


def draw_forces(ax: Any, run: Run, tip: Any, reach: float) -> None:
    """Both forces, with the directions that they have in the row where they are largest."""
    on_wall = run["f_on_wall"]
    size = np.linalg.norm(on_wall, axis=-1)
    row = int(size.argmax())
    if size[row] == 0:
        return
    pull = 0.3 * reach * on_wall[row] / size[row]
    peak = ForceRun(run).peak
    when = f", peak {peak.force:.4g} N at {peak.t:.4f} s" if peak else ""
    arrow(ax, tip[row], tip[row] + pull, ON_WALL, 2.2, label=f"force on the wall{when}")
    arrow(ax, tip[row], tip[row] - pull, ON_TIP, 2.2, label="force on the tip, the opposite")


def draw_walls(ax: Any, run: Run, scenario: Any, reach: float) -> None:
    """The wall at the start, at its first make, and at the end."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    origin = run["wall"]
    times = sorted({run.t[0], *[e.t for e in run.events if e.type == "make"][:1], run.t[-1]})
    for k, t in enumerate(times):
        corners = wall_outline(scenario, reach, t) + [np.interp(t, run.t, origin[:, c]) for c in range(3)]
        alpha = 0.12 + 0.2 * (k + 1) / len(times)
        ax.add_collection3d(Poly3DCollection([corners], fc=WALL, ec=BLACK, alpha=alpha, lw=0.8, zorder=1))
        ax.auto_scale_xyz(*corners.T, had_data=True)
    moments = ", ".join(f"{t:.4g}" for t in times)
    ax.plot([], [], color=WALL, alpha=0.4, lw=7, label=f"wall at {moments} s, darker is later")


def wall_outline(scenario: Any, reach: float, t: float) -> NDArray[np.float64]:
    """The four corners about the wall's origin at time t, s; an infinite wall is drawn one reach wide."""
    _, (e1,), (e2,) = wall_frame(scenario, t)
    half1, half2 = half_sides(scenario) or (reach / 2, reach / 2)
    return np.array([a * half1 * e1 + b * half2 * e2 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def arrow(
    ax: Any, start: Any, end: Any, colour: str, width: float, *, head: float = 0.25, label: str | None = None
) -> None:
    ax.auto_scale_xyz(*np.stack([start, end]).T, had_data=True)
    ax.quiver(*start, *(end - start), color=colour, lw=width, arrow_length_ratio=head, zorder=7, label=label)


def fit(ax: Any, ahead: float) -> None:
    """One scale and one tick spacing on all axes, labels with units, and the arm seen from its right front."""
    from matplotlib.ticker import MaxNLocator, MultipleLocator

    limits = np.array([ax.get_xlim(), ax.get_ylim(), ax.get_zlim()])
    spans = limits[:, 1] - limits[:, 0]
    ticks = MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(0, spans.max())
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.set_major_locator(MultipleLocator(ticks[1] - ticks[0]))
    ax.set(xlim=limits[0], ylim=limits[1], zlim=limits[2], xlabel="x, m", ylabel="y, m", zlabel="z, m")
    ax.set_box_aspect(spans, zoom=0.92)
    ax.xaxis.labelpad = 9
    ax.view_init(elev=20, azim=np.degrees(ahead) - 72)
