"""What the pages of a run, a batch and a scenario hold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import Arm3rError
from . import html, small_figure

if TYPE_CHECKING:
    from ..core.batch import Batch
    from ..core.run import Run
    from ..core.scenario import Scenario

DRAWN = ("force_error_rms", "peak_force", "tip_path_error_rms", "first_contact", "energy_dissipated", "tip_z")
SHOWN = ("t_end", "contacts", "contact_time", "peak_force", "final_force", "force_error_rms", "tip_path_error_rms")


def _often(count: int) -> str:
    return {0: "never", 1: "once", 2: "twice"}.get(count, f"{count} times")


def of_run(run: Run) -> str:
    """Outcome, numbers, checks, warnings and a small figure."""
    summary, kinds = run.summary, [event.type for event in run.events]
    numbers = [
        ("rows", len(run)),
        ("from t =", f"{run.t[0]:.6g} to {run.t[-1]:.6g} s"),
        ("contact begins", _often(kinds.count("make"))),
        ("contact ends", _often(kinds.count("break"))),
        ("peak force", f"{summary.get('peak_force', 0):.6g} N"),
        ("energy residual", f"{summary.get('energy_residual_max', 0):.2g} J"),
    ]
    return html.page(
        html.heading("Run", summary["name"], run.outcome, good=run.outcome == "ok"),
        html.notes("It did not reach its end:", [summary["message"]] if summary["message"] else []),
        html.facts(numbers),
        _checks(run),
        html.notes("Warnings:", run.warnings),
        html.image(small_figure.of_run(run), small_figure.WIDTH, "joint angles, and force or tip, over time"),
    )


def _checks(run: Run) -> str:
    if not run.checks:
        return ""
    rows = [
        (check["name"], "passed" if check["passed"] else "failed", check.get("value"), check.get("limit", ""))
        for check in run.checks
    ]
    colours = [html.GOOD if check["passed"] else html.BAD for check in run.checks]
    return html.table(("check", "", "value", "limit"), rows, colours=colours)


def of_scenario(scenario: Scenario) -> str:
    """What is simulated, the initial pose and the wall, and all values; or the problems of one that is not valid."""
    try:
        yaml = scenario.to_yaml()
    except Arm3rError as error:
        problems = str(error).splitlines()
        return html.page(html.heading("Scenario", scenario.file, "not valid", good=False), html.notes("", problems))
    wall = scenario["wall.motion.type"] if "wall" in scenario else "none"
    numbers = [
        ("convention", scenario["arm.convention"]),
        ("controller", scenario["controller.type"]),
        ("wall", wall),
        ("solver", scenario["solver.method"]),
        ("until t =", f"{scenario['time.stop']:.6g} s"),
        ("checks", len(scenario["checks"] or [])),
    ]
    return html.page(
        html.heading("Scenario", scenario.name),
        html.facts(numbers),
        html.notes("Warnings:", scenario.warnings),
        html.image(small_figure.of_scenario(scenario), small_figure.WIDTH, "the arm and the wall at the start"),
        html.folded("all values", yaml),
    )


def of_batch(batch: Batch[Any]) -> str:
    """How the runs ended, the range of their numbers, and one of these over the axes."""
    words, counts = np.unique(batch.outcomes, return_counts=True)
    state = ", ".join(f"{count} {word}" for word, count in zip(words, counts, strict=True))
    shown, drawable = ([name for name in names if name in batch.names] for names in (SHOWN, DRAWN))
    ranges = [(name, batch.units[name], *_range(batch, name)) for name in shown if np.isfinite(batch[name]).any()]
    drawn = next((name for name in drawable if np.ptp(_finite(batch, name)) > 0), "") if batch.ok.any() else ""
    png = small_figure.of_batch(batch, drawn) if drawn else None
    return html.page(
        html.heading("Batch of runs over", ", ".join(batch.axes) or "nothing", state, good=bool(batch.ok.all())),
        html.facts([("runs", len(batch)), ("shape", batch.shape)]),
        html.table(("", "unit", "least", "median", "greatest"), ranges) if ranges else "",
        html.image(png, small_figure.WIDTH, drawn) if png else "",
    )


def _finite(batch: Batch[Any], name: str) -> np.ndarray:
    values = batch[name][np.isfinite(batch[name])]
    return values if values.size else np.zeros(1)


def _range(batch: Batch[Any], name: str) -> tuple[float, float, float]:
    values = _finite(batch, name)
    return float(values.min()), float(np.median(values)), float(values.max())
