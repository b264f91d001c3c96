"""What `arm3r run --controller` says of two controllers, in lines and as JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .._messages import in_columns, shown

if TYPE_CHECKING:
    from ..core.comparison import Beside
    from ..core.run import Run

UNITS = {"q": ("rad", "joint angles"), "tip": ("m", "tip"), "tau": ("N m", "torque"), "force": ("N", "contact force")}
OTHER_CONVENTION = 1e-6
"""Of the torque: a sum below that says that two torques are opposite."""


def report(beside: Beside) -> str:
    """The lines behind the summary of the user's run."""
    lines = [f"  controller      {shown(beside.name)}"]
    if beside.true is None:
        return "\n".join([*lines, "  compared with   nothing: the scenario has no controller of its own"])
    ended = "" if beside.true.outcome == "ok" else f", which ended as {beside.true.outcome}"
    lines.append(f"  compared with   {beside.true_name} at the same samples{ended}")
    if not beside.rows:
        return "\n".join([*lines, "  difference      no row to compare"])
    lines.append(table(beside))
    if is_opposite(beside.yours, beside.true):
        lines.append(
            f"  The torques are opposite at the start. The scenario's convention is {convention_of(beside.yours)}: is "
            "the function in the other one?"
        )
    return "\n".join(lines)


def table(beside: Beside) -> str:
    """A line a quantity: yours and the scenario's at the end, and the largest difference."""
    assert beside.true
    last = beside.rows - 1
    end = f"at {beside.yours.t[last]:.6g} s"
    rows: list[tuple[str, ...]] = [("", f"yours {end}", f"the scenario's {end}", "largest difference")]
    for name, difference in beside.differences.items():
        unit, words = UNITS[name]
        column = "f_on_wall" if name == "force" else name
        ends = (numbers(run[column][last]) for run in (beside.yours, beside.true))
        rows.append((f"{words}, {unit}", *ends, f"{difference.size:.3g} at {difference.t:.6g} s"))
    return "\n".join(f"  {line}" for line in in_columns(rows))


def numbers(values: Any) -> str:
    return "  ".join(f"{value:.6g}" for value in np.round(values, 12) + 0.0)


def is_opposite(yours: Run, true: Run) -> bool:
    """Whether the first torques are each other's negative, and not zero."""
    first, other = yours["tau"][0], true["tau"][0]
    size = float(np.abs(other).max())
    return size > 0 and float(np.abs(first + other).max()) < OTHER_CONVENTION * size


def convention_of(run: Run) -> str:
    from ..core.scenario import Scenario

    return str(Scenario(run.summary["scenario"])["arm.convention"])


def as_json(beside: Beside) -> dict[str, Any]:
    """What the JSON summary of the user's run has under `beside`."""
    return {
        "controller": beside.name,
        "true_controller": beside.true_name or None,
        "true_outcome": beside.true.outcome if beside.true else None,
        "true_hash": beside.true.summary["hash"] if beside.true else None,
        "differences": {name: {"largest": one.size, "t": one.t} for name, one in beside.differences.items()},
    }
