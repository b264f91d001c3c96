"""The picture that an animation changes from frame to frame: the arm and the wall from the side and from above, and the
force over time."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, cast

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .._native import Floats
from ..core.arm_line import SAME
from ..core.run import Run
from ..core.scenario import Scenario
from ..plot.force_run import pressing_force
from ..plot.style import ARM, BLACK, ON_WALL, REFERENCE, TIP, WALL, contact_spans, style
from .frames import Frames

SIZE, DPI = (6.4, 4.8), 100  # inches, pixels an inch
GREY, PALE, GRID = "#777777", "#d9d9d9", "#e5e5e5"
LONGEST = 0.3  # of the arm's reach: about the longest arrow
FREE, TOUCHING = "#bbbbbb", WALL
SHADE = 0.2  # of the wall's colour: contact over time
INKS = (BLACK, ARM, TIP, ON_WALL, WALL, GREY, PALE, FREE)
GLASS = 3 / 8  # how much the plate hides
STEPS = 8  # between an ink and what is under it, where edges are smoothed


class View(NamedTuple):
    """One of the two projections, with what moves in it."""

    ax: Any
    axes: Floats
    """(2, 3): right and up"""
    arm: Any
    tip: Any
    trail: Any
    wanted: Any
    plate: Any
    arrow: Any

    def flat(self, points: Floats) -> Floats:
        """(..., 3) to (..., 2), m."""
        return points @ self.axes.T


class Scene:
    """Frames of a run, drawn one at a time over a background that is drawn once."""

    def __init__(self, run: Run, scenario: Scenario, frames: Frames) -> None:
        self.run, self.frames = run, frames
        self.has_wall = frames.plate is not None
        self.figure = Figure(figsize=SIZE, dpi=DPI)
        self.canvas = cast(Any, FigureCanvasAgg(self.figure))
        with style():
            self._prepare(run, scenario)
        self.digits = max(2, math.ceil(-math.log10(max(np.diff(frames.t).min(initial=1.0), 1e-9)) - 1e-9))
        self.canvas.draw()
        self.background = self.canvas.copy_from_bbox(self.figure.bbox)

    def draw(self, k: int) -> NDArray[np.uint8]:
        """Frame k: (height, width, 4), RGBA."""
        self.canvas.restore_region(self.background)
        for view in self.views:
            self._move(view, k)
            for artist in (view.plate, view.trail, view.arm, view.tip, view.arrow, view.wanted):
                if artist is not None:
                    view.ax.draw_artist(artist)
        self._tell(k)
        return np.asarray(self.canvas.buffer_rgba()).copy()

    # ---- what stands still ------------------------------------------------------------------------------------------

    def _prepare(self, run: Run, scenario: Scenario) -> None:
        self.newtons = newtons_per_metre(self.frames.force.max(), LONGEST * scenario.arm.reach)
        self.views = self._views()
        self.clock = self.figure.text(0.04, 0.955, "", va="center", family="monospace", fontsize=10, animated=True)
        self.flag: Any = self.figure.text(0.96, 0.955, "", va="center", ha="right", fontsize=10, animated=True)
        self.flag.set_bbox({"boxstyle": "round,pad=0.3", "ec": BLACK, "lw": 0.6})
        self.past: Any = None
        self.now: Any = None
        if self.has_wall:
            self._strip(run, scenario)

    def _views(self) -> list[View]:
        right, name = sight(self.frames)
        left = np.cross([0, 0, 1], right)
        foot, height = (0.385, 0.50) if self.has_wall else (0.12, 0.76)
        aligned = name == "x"
        labels = ("x, m", "z, m", "y, m") if aligned else (f"{name}, m", "z, m", "across, m")
        sides = np.stack([right, [0, 0, 1]]), np.stack([right, left])
        spans = limits(self.frames, sides, self.newtons)
        views = []
        for i, (axes, span, title) in enumerate(zip(sides, spans, ("from the side", "from above"), strict=True)):
            ax = self.figure.add_axes((0.09 + 0.49 * i, foot, 0.40, height))
            ax.set(xlim=span[0], ylim=span[1], xlabel=labels[0], ylabel=labels[1 + i])
            ax.set_title(title, fontsize=9, loc="left", pad=3)
            ax.set_aspect("equal")
            ax.grid(color=GRID, lw=0.6)
            ax.set_axisbelow(True)
            ax.tick_params(labelsize=8)
            ax.locator_params(nbins=6, steps=[1, 2, 5, 10])
            self._base(ax, axes)
            views.append(self._view(ax, axes))
        return views

    def _base(self, ax: Any, axes: Floats) -> None:
        """The column, which is a dot where one looks along it."""
        ends = np.stack([self.frames.foot, self.frames.joints[0, 0]]) @ axes.T
        if np.ptp(ends, axis=0).max() > SAME:
            ax.plot(*ends.T, color=GREY, lw=6, solid_capstyle="butt", zorder=1)
        else:
            ax.plot(*ends[:1].T, color=GREY, marker="o", ms=11, ls="", zorder=1)

    def _view(self, ax: Any, axes: Floats) -> View:
        still: Any = {"animated": True}
        arm = ax.plot(
            [], [], color=ARM, lw=4, marker="o", ms=5, mfc="white", mec=BLACK, solid_capstyle="round",
            markevery=self.frames.marked, **still,
        )[0]  # fmt: skip
        tip = ax.plot([], [], marker="o", ms=6, mec=BLACK, ls="", **still)[0]
        trail = ax.plot([], [], color=TIP, lw=1.0, **still)[0]
        wanted = plate = arrow = None
        if self.frames.reference is not None:
            wanted = ax.plot([], [], color=REFERENCE, marker="+", ms=9, mew=1.3, ls="", **still)[0]
        if self.has_wall:
            plate = ax.fill([0], [0], lw=3.0, joinstyle="round", **still)[0]
            arrow = ax.quiver(
                [0], [0], [0], [0], color=ON_WALL, angles="xy", scale_units="xy", scale=1, width=0.014, minlength=0,
                **still,
            )  # fmt: skip
        return View(ax, axes, arm, tip, trail, wanted, plate, arrow)

    def _strip(self, run: Run, scenario: Scenario) -> None:
        """The force over time."""
        ax = self.figure.add_axes((0.09, 0.10, 0.89, 0.14))
        force = pressing_force(run, scenario)
        ax.plot(run.t, force, color=PALE, lw=1.2)
        highest = float(force.max())
        if "force_ref" in run:
            ax.plot(run.t, run["force_ref"], color=REFERENCE, ls="--", lw=0.9)
            highest = max(highest, float(run["force_ref"].max()))
        bars = [(start, end - start) for start, end in contact_spans(run)]
        ax.broken_barh(bars, (0, 1), transform=ax.get_xaxis_transform(), color=WALL, alpha=SHADE, lw=0, zorder=0)
        ax.set(xlim=(run.t[0], max(run.t[-1], run.t[0] + 1e-9)), xlabel="t, s", ylabel="force, N")
        room = 0.08 * max(highest - min(0.0, force.min()), 1e-6)
        ax.set_ylim(min(0.0, force.min()) - room, highest + room)
        ax.tick_params(labelsize=8)
        ax.set_title(f"force on the wall (arrow: {self.newtons:g} N a metre)", fontsize=8, loc="left", pad=2)
        self.force_line = run.t, force
        self.past = ax.plot([], [], color=ON_WALL, lw=1.4, animated=True)[0]
        self.now = ax.axvline(run.t[0], color=BLACK, lw=1.0, animated=True)

    # ---- what moves -------------------------------------------------------------------------------------------------

    def _move(self, view: View, k: int) -> None:
        frames = self.frames
        joints, colour = view.flat(frames.joints[k]), TOUCHING if frames.contact[k] else FREE
        view.arm.set_data(*joints.T)
        view.tip.set_data(*joints[-1:].T)
        view.tip.set_markerfacecolor(TIP if frames.contact[k] else "white")
        view.trail.set_data(*view.flat(frames.joints[: k + 1, -1]).T)
        if view.wanted is not None and frames.reference is not None:
            view.wanted.set_data(*view.flat(frames.reference[k : k + 1]).T)
        if frames.plate is not None:
            view.plate.set_xy(view.flat(frames.plate[k]))
            view.plate.set(fc=(colour, GLASS), ec=TOUCHING if frames.contact[k] else GREY)
            view.arrow.set_offsets(joints[-1])
            view.arrow.set_UVC(*(view.flat(frames.force_on_wall[k]) / self.newtons))

    def _tell(self, k: int) -> None:
        t, force = self.frames.t[k], self.frames.force[k]
        text = f"t = {t:.{self.digits}f} s"
        if self.past is not None:
            line, upto = self.force_line, np.searchsorted(self.run.t, t, side="right")
            self.past.set_data(line[0][:upto], line[1][:upto])
            self.now.set_xdata([t, t])
            for artist in (self.past, self.now):
                artist.axes.draw_artist(artist)
            text += f"   force {force:6.2f} N"
            self.flag.set_text("contact" if self.frames.contact[k] else "no contact")
            self.flag.get_bbox_patch().set_facecolor(TOUCHING if self.frames.contact[k] else "white")
            self.figure.draw_artist(self.flag)
        self.clock.set_text(text)
        self.figure.draw_artist(self.clock)


def sight(frames: Frames) -> tuple[Floats, str]:
    """What points to the right, (3,), and its name: towards the wall; without an upright one, where the arm points."""
    ahead = frames.joints[0, -1] - frames.joints[0, 0]
    name = "ahead"
    if frames.plate is not None:
        sides = frames.plate[0, 1] - frames.plate[0, 0], frames.plate[0, 3] - frames.plate[0, 0]
        into = np.cross(*sides)
        if np.hypot(into[0], into[1]) > 0.1 * np.linalg.norm(into):
            ahead, name = into, "towards the wall"
    size = np.hypot(ahead[0], ahead[1])
    right = np.array([ahead[0], ahead[1], 0.0]) / size if size > 1e-9 else np.array([1.0, 0.0, 0.0])
    return right, "x" if right[0] > 1 - 1e-9 else name


def limits(frames: Frames, sides: tuple[Floats, Floats], newtons: float) -> list[Floats]:
    """Of both views, (2, 2) each, on one scale: what encloses arm, arrow and wall of all frames."""
    arrows = frames.joints[:, -1] + frames.force_on_wall / newtons
    points = [frames.joints.reshape(-1, 3), arrows, frames.foot[None]]
    points += [] if frames.plate is None else [frames.plate.reshape(-1, 3)]
    boxes = []
    for axes in sides:
        flat = np.concatenate(points) @ axes.T
        boxes.append(np.stack([flat.min(axis=0), flat.max(axis=0)], axis=1))
    boxes[1][0] = boxes[0][0]
    half = 0.54 * max(float(np.diff(box, axis=1).max()) for box in boxes)
    return [box.mean(axis=1, keepdims=True) + half * np.array([-1, 1]) for box in boxes]


def palette() -> NDArray[np.uint8]:
    """The colours of a scene, (colours, 3): all inks over all grounds, in steps."""
    from matplotlib.colors import to_rgb

    white, wall = np.ones(3), np.array(to_rgb(WALL))
    grounds = [white, (1 - SHADE) * white + SHADE * wall, np.array(to_rgb(GRID))]
    share = np.linspace(0, 1, STEPS + 1)[:, None]
    ramps = [(1 - share) * ground + share * np.array(to_rgb(ink)) for ground in grounds for ink in INKS]
    return np.unique((255 * np.concatenate(ramps)).round().astype(np.uint8), axis=0)


def newtons_per_metre(force: float, length: float) -> float:
    """A round scale, 1, 2 or 5 times a power of ten, on which a force is about so long."""
    if force <= 0:
        return 1.0
    wanted = force / length
    power = 10.0 ** math.floor(math.log10(wanted))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= wanted * (1 - 1e-9))
