"""What each frame of an animation shows, from the rows of a run."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._native import Floats
from ..core.arm_line import arm_line, base_axes
from ..core.run import Run
from ..core.scenario import Scenario
from ..errors import UsageError
from ..plot.force_run import pressing_force
from ..plot.style import contact_spans
from ..plot.wall_frame import half_sides, wall_frame

MOST = 3000  # frames
INFINITE = 0.6  # of the arm's reach: half the side of an infinite wall as it is drawn
COLUMN = 0.2  # of the arm's reach: the length of the column that carries it


class Frames(NamedTuple):
    """Arrays with a row for each frame: m, N, s, base axes."""

    t: Floats
    joints: Floats
    """(frames, points, 3): the arm as a line, from axis 1 to the tip; a planar one has joint 2, joint 3 and the tip."""
    marked: list[int]
    """Points of the line that are joint 2, joint 3 and the tip."""
    foot: Floats
    """(3,): where the column begins that carries the arm."""
    reference: Floats | None
    """(frames, 3): reference of the tip"""
    plate: Floats | None
    """(frames, 4, 3): its corners"""
    force: Floats
    """Pressing; where none is left, the largest one since the frame before, so that no short contact is lost."""
    force_on_wall: Floats
    """(frames, 3), of the same moment"""
    contact: Floats
    """1 where there was contact since the frame before, else 0."""


def frame_times(run: Run, *, fps: float, speed: float, every: int | None) -> Floats:
    """Of each frame: as the run's time passes `speed` times as fast as the film's; or those of each `every`-th row.

    Raises:
        UsageError: these are too many.
    """
    start, end = float(run.t[0]), float(run.t[-1])
    if every is None:
        count = int((end - start) * fps / speed + 1e-6)
        many, hint = count + 2, f"--speed {(end - start) * fps / MOST:.3g} or more"
    else:
        many, hint = len(run.t) // every + 2, f"--every {len(run.t) // MOST + 1} or more"
    if many > MOST + 2:
        raise UsageError(f"{many - 2} frames: {MOST} are possible; use {hint}", code="usage")
    t: Floats = start + speed / fps * np.arange(count + 1.0) if every is None else run.t[::every]
    return t if t[-1] >= end - 1e-9 * max(1.0, end) else np.append(t, end)


def frames_of(run: Run, scenario: Scenario, t: Floats) -> Frames:
    """The run as it is shown at times t, s."""
    arm = scenario.arm
    joints, places = arm_line(arm, at(run, "q", t))
    joints[:, -1] = at(run, "tip", t)
    foot = joints[0, 0] - COLUMN * arm.reach * base_axes(scenario)[:, 2]
    reference = at(run, "tip_ref", t) if "tip_ref" in run else None
    wall = plate(run, scenario, t)
    return Frames(t, joints, [*places, -1], foot, reference, wall, *shown_forces(run, scenario, t), touched(run, t))


def at(run: Run, name: str, t: Floats) -> Floats:
    """Three columns at times t, straight between rows: (frames, 3)."""
    return np.stack([np.interp(t, run.t, column) for column in run[name].T], axis=1)


def plate(run: Run, scenario: Scenario, t: Floats) -> Floats | None:
    if "wall" not in run:
        return None
    infinite = INFINITE * scenario.arm.reach
    half1, half2 = half_sides(scenario) or (infinite, infinite)
    frame, centre = wall_frame(scenario, t), at(run, "wall", t)
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return np.stack([centre + a * half1 * frame.e1 + b * half2 * frame.e2 for a, b in corners], axis=1)


def shown_forces(run: Run, scenario: Scenario, t: Floats) -> tuple[Floats, Floats]:
    """At each time: the force, or where there is none, the largest one of the rows since the time before."""
    if "wall" not in run:
        return np.zeros(len(t)), np.zeros((len(t), 3))
    force, on_wall = pressing_force(run, scenario), run["f_on_wall"]
    ends = np.searchsorted(run.t, t, side="right")
    rows = [
        start + int(force[start:end].argmax()) for start, end in zip([0, *ends[:-1]], ends, strict=True) if end > start
    ]
    shown = np.flatnonzero(np.diff(ends, prepend=0))
    found, found_on_wall = np.interp(t, run.t, force), at(run, "f_on_wall", t)
    lost = (found[shown] <= 0) & (force[rows] > 0)
    found[shown[lost]], found_on_wall[shown[lost]] = force[rows][lost], on_wall[rows][lost]
    return found, found_on_wall


def touched(run: Run, t: Floats) -> Floats:
    before = np.concatenate([t[:1], t[:-1]])
    on = np.zeros(len(t))
    for start, end in contact_spans(run):
        on[(before <= end) & (t >= start)] = 1
    return on
