"""Two runs, with a controller of the user's own and with the scenario's, and how far apart they are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..errors import Arm3rError
from .provided import provided
from .run import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Difference(NamedTuple):
    """The largest difference of a quantity between two runs."""

    size: float
    """Of a vector its length."""
    t: float
    """s: the row in which it is"""


class Beside:
    """A run with a controller of your own, and the run with the scenario's. `print` shows how far apart they are.

    Attributes:
        yours: the run with your controller.
        true: the run with the scenario's controller; None where there is none: a scenario without a law.
        name: your function, with its file and arguments.
        true_name: the scenario's `controller.type`; "" where there is none.
        failure: what ended your run early; None: nothing.
    """

    def __init__(self, yours: Run, true: Run | None, name: str, true_name: str, failure: Arm3rError | None) -> None:
        self.yours, self.true, self.name, self.true_name, self.failure = yours, true, name, true_name, failure

    def __str__(self) -> str:
        return str(provided("report of two controllers")(self))

    def __repr__(self) -> str:
        return f"<Beside: {self.name} and {self.true_name or 'no other controller'}>"

    def figure(self, **options: Any) -> Figure:
        """Both runs over each other, and below them the difference; options as of `arm3r_cpp.plot.overview`."""
        figure: Figure = provided("figure of two controllers")(self, **options)
        return figure

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
