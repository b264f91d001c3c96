"""A controller of the user's own and the true one, each in a run of its own, and how far apart they are."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import _native
from ..control.law import Law, name_of
from ..errors import Arm3rError
from ..run import Run
from .block import Block

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..scenario import Scenario

GRAVITY = "gravity_compensation"
WITHOUT_GRAVITY = ("none", "constant", "user")
"""Controllers beside which a gravity torque is not held: they do not carry the arm."""
NO_LAW = ("none", "user")


class Difference(NamedTuple):
    """The largest difference of a quantity between two runs."""

    size: float
    """Of a vector its length."""
    t: float
    """s: the row in which it is"""


class Beside:
    """A run with a controller of your own, and the run with the true one.

    Attributes:
        yours: the run with your controller.
        true: the run with the true one; None where there is none: a scenario without a law.
        name: your function, with its file and arguments.
        true_name: the true one's `controller.type`; "" where there is none.
        failure: what ended your run early; None: nothing.
    """

    def __init__(self, yours: Run, true: Run | None, name: str, true_name: str, failure: Arm3rError | None) -> None:
        self.yours, self.true, self.name, self.true_name, self.failure = yours, true, name, true_name, failure

    @property
    def rows(self) -> int:
        """How many rows, from the first on, both runs have at the same times; 0 without a true run."""
        if self.true is None:
            return 0
        count = min(len(self.yours), len(self.true))
        apart = np.flatnonzero(self.yours.t[:count] != self.true.t[:count])
        return int(apart[0]) if apart.size else count

    @property
    def differences(self) -> dict[str, Difference]:
        """The largest differences over these rows, by quantity: q (rad), tip (m), tau (N m), and with a wall force (N).

        `force` is the contact force. Without a row that both have: {}.
        """
        names = {"q": "q", "tip": "tip", "tau": "tau", **({"force": "f_on_wall"} if "depth" in self.yours else {})}
        found = {name: column for name, column in names.items() if self.rows and column in self.yours}
        return {name: self._difference(column) for name, column in found.items()}

    def _difference(self, column: str) -> Difference:
        assert self.true
        apart = np.linalg.norm(self.yours[column][: self.rows] - self.true[column][: self.rows], axis=1)
        row = int(np.argmax(apart))
        return Difference(float(apart[row]), float(self.yours.t[row]))

    def __str__(self) -> str:
        from .report import report

        return report(self)

    def __repr__(self) -> str:
        return f"<Beside: {self.name} and {self.true_name or 'no other controller'}>"

    def figure(self, **options: Any) -> Figure:
        """Both runs over each other, and below them the difference; options as of `arm3r_cpp.plot.overview`."""
        from .figure import figure

        return figure(self, **options)


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

    is_gravity: whether the user's function is a gravity torque. None: there is no true one.
    """
    true = scenario.copy()._quiet()
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
