"""What figures show of a run: force, peak, settling, contact, tracking errors, limits."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from .._native import Floats
from ..core.run import Run
from ..core.scenario import Scenario
from ..errors import UsageError
from .style import angle_unit, contact_spans
from .wall_frame import WallFrame, half_sides, wall_frame

SETTLED = 0.05  # of what is wanted: the force has settled within that
NEEDED = ("t", "tau", "tip", "contact")
SEEN = 0.99  # of the peak: rows that come as near as this show it


class Peak(NamedTuple):
    """The largest normal force: N, and where it was, s."""

    t: float
    force: float
    seen: bool
    """Whether rows show it; else it lies between two of them."""
    exact: bool
    """Whether the summary tells the instant; else t is that of a row, or an estimate."""


class Settling(NamedTuple):
    start: float
    """s: the first contact"""
    duration: float | None
    """s; None: it never settles"""


class ForceRun:
    """A run and what figures compute of it. Arrays have a row for each row of the run; None: the run lacks it."""

    def __init__(self, run: Run, *, name: str | None = None, degrees: bool | None = None) -> None:
        """degrees: for angles; None: as the scenario gives them."""
        self.run = run
        self.name = name or run.summary["name"]
        self.angle = angle_unit(self.scenario, degrees)

    def check(self) -> None:
        """
        Raises:
            UsageError: a column is missing, and nothing else tells what it holds.
        """
        missing = [column for column in NEEDED if column not in self.run]
        if missing:
            why = "log all columns" if self.run.has_chosen_columns else "use a run as arm3r writes it"
            raise UsageError(f"{self.name}: no column {missing[0]}; {why}", code="usage")
        if not self.has_force:
            has_wall = "depth" in self.run
            near = "its summary holds no scenario to tell the normal" if has_wall else "the run has no wall"
            raise UsageError(f"{self.name}: no column force, and {near}; run a scenario with a wall", code="usage")

    @property
    def has_force(self) -> bool:
        """Whether the columns tell how strongly the tip presses."""
        return "force" in self.run or ("depth" in self.run and "f_on_tip" in self.run and self.scenario is not None)

    @cached_property
    def scenario(self) -> Scenario | None:
        text = self.run.summary.get("scenario")
        return Scenario(text) if text else None

    def metric(self, name: str) -> Any:
        """A number of the summary; None: it has none, or it does not apply."""
        return {**self.run.summary, **(self.run.summary.get("metrics") or {})}.get(name)

    def has_metric(self, name: str) -> bool:
        return name in self.run.summary or name in (self.run.summary.get("metrics") or {})

    def column(self, name: str) -> Floats | None:
        if name not in self.run:
            return None
        return self.run[name]

    # ---- force, N, pressing is positive -----------------------------------------------------------------------------

    @cached_property
    def force(self) -> Floats:
        """The true one."""
        return pressing_force(self.run, self.scenario)

    @property
    def force_line(self) -> tuple[Floats, Floats]:
        """Time and force as they are drawn: rows, and zero where contact is made and lost between them."""
        t, first = np.unique([*self.run.t, *(event.t for event in self.run.events)], return_index=True)
        return t, np.concatenate([self.force, np.zeros(len(self.run.events))])[first]

    @property
    def reference(self) -> Floats | None:
        return self.column("force_ref")

    @property
    def estimate(self) -> Floats | None:
        """From the momentum observer."""
        if "f_estimate" not in self.run or self.frame is None:
            return None
        return np.sum(self.run["f_estimate"] * self.frame.normal, axis=1)

    @property
    def error(self) -> Floats | None:
        """Force minus reference; NaN out of contact."""
        if self.reference is None:
            return None
        return np.where(self.run["contact"] > 0, self.force - self.reference, np.nan)

    @cached_property
    def peak(self) -> Peak | None:
        force, t = self.force, self.run.t
        level = max(self.metric("peak_force") or 0.0, float(force.max()))
        row = int(force.argmax())
        if level <= 0:
            return None
        seen = bool(force[row] >= SEEN * level)
        instant = self.metric("peak_force_time")
        if instant is not None:
            return Peak(float(instant), level, seen, exact=True)
        return Peak(float(t[row]) if seen else self._peak_between_rows(level), level, seen, exact=False)

    @property
    def first_peak(self) -> Peak | None:
        """Of the first contact, while it is transient, as the summary tells it; None: it does not."""
        force, instant = self.metric("first_contact_peak"), self.metric("first_contact_peak_time")
        if not force or instant is None:
            return None
        nearest = self.force[np.abs(self.run.t - instant).argmin()]
        return Peak(float(instant), float(force), bool(nearest >= SEEN * force), exact=True)

    def _peak_between_rows(self, level: float) -> float:
        """Where parabolas through rows and events come highest; else in the longest contact that no row saw."""
        at, top = _parabola_tops(*self.force_line)
        spans = contact_spans(self.run)
        rows = np.searchsorted(self.run.t, spans)
        unseen = [span for span, (first, end) in zip(spans, rows, strict=True) if first == end]
        if unseen and (not len(top) or top.max() < 0.8 * level):
            start, end = max(unseen, key=lambda span: span[1] - span[0])
            return (start + end) / 2
        return float(at[top.argmax()]) if len(top) else float(self.run.t[self.force.argmax()])

    @property
    def settling(self) -> Settling | None:
        """As the summary tells it; None: it does not."""
        makes = [event.t for event in self.run.events if event.type == "make"]
        if not self.has_metric("settling_time") or self.reference is None or not makes:
            return None
        return Settling(makes[0], self.metric("settling_time"))

    # ---- limits -----------------------------------------------------------------------------------------------------

    @property
    def torque_limit(self) -> list[float]:
        """N m, one for each joint; inf: none."""
        given = self.run.summary.get("torque_limit")
        if given is None:
            given = self.scenario["arm.torque_limit"] if self.scenario else [None] * 3
        return [math.inf if limit is None else float(limit) for limit in given]

    @property
    def threshold(self) -> list[float] | None:
        """N m, one for each residual."""
        if not self.scenario or "observer.threshold" not in self.scenario:
            return None
        return np.broadcast_to(self.scenario["observer.threshold"], 3).tolist()

    # ---- on the wall's face -----------------------------------------------------------------------------------------

    @cached_property
    def frame(self) -> WallFrame | None:
        if self.scenario is None or "wall" not in self.run:
            return None
        return wall_frame(self.scenario, self.run.t)

    @property
    def half_sides(self) -> tuple[float, float] | None:
        """Of the plate, m; None: infinite."""
        return half_sides(self.scenario) if self.scenario and "wall" in self.run else None

    def on_contact_plane(self, name: str) -> Floats | None:
        """A position as (rows, 2): along e1 and e2 from the plate's centre, m."""
        if self.frame is None or name not in self.run:
            return None
        return self._along_frame(self.run[name] - self.run["wall"])[:, :2]

    @property
    def path_error(self) -> dict[str, Floats]:
        """Tip minus its reference by direction, m: on the wall's face; and into it, zero while force is controlled.

        Its size is what the summary's `tip_path_error_max` is the largest of.
        """
        if "tip_ref" not in self.run:
            return {}
        error = self.run["tip"] - self.run["tip_ref"]
        if self.frame is None:
            return dict(zip(("x", "y", "z"), error.T, strict=True))
        along = dict(zip(("e_1", "e_2", "n"), self._along_frame(error).T, strict=True))
        phase = self.column("force_phase")
        if phase is not None:
            along["n"] = (1 - phase) * along["n"]
        return along

    @property
    def joint_error(self) -> dict[str, Floats]:
        """Joint angles minus their references, rad."""
        if "q_ref" not in self.run:
            return {}
        return dict(zip(("q_1", "q_2", "q_3"), (self.run["q"] - self.run["q_ref"]).T, strict=True))

    def _along_frame(self, vectors: Floats) -> Floats:
        """(rows, 3) in base axes to (rows, 3) along e1, e2 and the normal."""
        assert self.frame is not None
        return np.stack(
            [np.sum(vectors * axis, axis=1) for axis in (self.frame.e1, self.frame.e2, self.frame.normal)], 1
        )


def pressing_force(run: Run, scenario: Scenario | None) -> Floats:
    """The true normal contact force of a run with a wall, N."""
    if "force" in run or scenario is None:
        return run["force"]
    return np.sum(run["f_on_tip"] * wall_frame(scenario, run.t).normal, axis=1)


def _parabola_tops(t: Floats, f: Floats) -> tuple[Floats, Floats]:
    """Time and height of the parabola through each local maximum and its two neighbours."""
    i = 1 + np.flatnonzero((f[1:-1] > 0) & (f[1:-1] >= f[:-2]) & (f[1:-1] >= f[2:]) & (f[:-2] + f[2:] < 2 * f[1:-1]))
    before, after = t[i] - t[i - 1], t[i + 1] - t[i]
    rise, fall = (f[i] - f[i - 1]) / before, (f[i + 1] - f[i]) / after
    bend = (fall - rise) / (before + after)
    slope = rise + bend * before
    return t[i] - slope / (2 * bend), f[i] - slope**2 / (4 * bend)
