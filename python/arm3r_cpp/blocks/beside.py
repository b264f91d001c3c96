"""A controller of the user's own and the scenario's, each in a run of its own, and how far apart they are."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from .. import _native
from ..control.law import Law, name_of
from ..core.comparison import Beside
from ..core.run import Run
from ..errors import Arm3rError
from .block import Block

if TYPE_CHECKING:
    from ..core.scenario import Scenario

GRAVITY = "gravity_compensation"
WITHOUT_GRAVITY = ("none", "constant", "user")
"""Controllers beside which a gravity torque is not held: they do not carry the arm."""
NO_LAW = ("none", "user")


def run_beside(
    scenario: Scenario,
    controller: Law | Block | str | os.PathLike[str],
    *,
    rate: float | None = None,
    progress: _native.Progress | None = None,
    time_limit: float | None = None,
) -> Beside:
    """What `Scenario.run_beside` does."""
    options: dict[str, Any] = {"progress": progress, "time_limit": time_limit}
    given = Block.read(controller) if isinstance(controller, (str, os.PathLike)) else controller
    law, name = (given.law(scenario), str(given)) if isinstance(given, Block) else (given, name_of(given))
    yours, failure = as_far_as_it_came(scenario, controller=law, rate=rate, **options)
    true = true_scenario(scenario, isinstance(given, Block) and given.is_gravity, rate)
    if true is None:
        return Beside(yours, None, name, "", failure)
    return Beside(yours, as_far_as_it_came(true, **options)[0], name, true["controller.type"], failure)


def as_far_as_it_came(scenario: Scenario, **options: Any) -> tuple[Run, Arm3rError | None]:
    """The run, and what ended it early."""
    try:
        return scenario.run(**options), None
    except Arm3rError as error:
        if error.run is None:
            raise
        return error.run, error


def true_scenario(scenario: Scenario, is_gravity: bool, rate: float | None) -> Scenario | None:
    """With the true controller at the samples of the user's, and its torque held, too: what differs is the law alone.

    is_gravity: whether the user's function is a gravity torque. None: the scenario has none.
    """
    true = scenario.copy().quiet()
    true["checks"] = []
    if is_gravity and true["controller.type"] in WITHOUT_GRAVITY:
        true.update({"controller": {"type": GRAVITY}, "reference": None})
    if true["controller.type"] in NO_LAW:
        return None
    if true["controller.type"] != "constant":  # whose torque is the same at all times
        if rate is not None:
            true["sampling.rate"] = rate
        elif true["sampling"] is None:
            true["sampling"] = {}
    return true
