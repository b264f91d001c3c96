"""arm3r: dynamics, wall contact and simulation of a 3R spatial arm.

>>> import arm3r_cpp as arm3r
>>> run = arm3r.Scenario.example("moving_wall").run()
>>> run["f_on_wall_x"][-1], run.events, run.passed

`Scenario` reads, changes and runs scenarios, `Run` holds results, `Arm` has the functions of the model, `plot` draws,
and each kind of error has its class (`Arm3rError` is the base of all). Units are SI and radians.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from .core.provided import provide

TYPE_CHECKING = False  # importing it from typing would cost more than all the rest here
if TYPE_CHECKING:
    from typing import Any

    from . import plot as plot
    from . import verify as verify
    from ._api import *  # noqa: F403


provide(
    {
        "batch to pandas": f"{__name__}.notebook.tables:batch_to_pandas",
        "batch to xarray": f"{__name__}.notebook.tables:batch_to_xarray",
        "figure of measured rows": f"{__name__}.measured.figure:measured",
        "figure of two controllers": f"{__name__}.blocks.figure:figure",
        "film of a run": f"{__name__}.animation.animate:animate",
        "function of a file": f"{__name__}.blocks.block:Block.read",
        "live page of a run": f"{__name__}.live.show:write",
        "page of a batch": f"{__name__}.notebook.pages:of_batch",
        "page of a run": f"{__name__}.notebook.pages:of_run",
        "page of a scenario": f"{__name__}.notebook.pages:of_scenario",
        "report of two controllers": f"{__name__}.blocks.report:report",
        "run of two controllers": f"{__name__}.blocks.beside:run_beside",
        "run to pandas": f"{__name__}.notebook.tables:run_to_pandas",
        "run to xarray": f"{__name__}.notebook.tables:run_to_xarray",
    }
)


def __getattr__(name: str) -> Any:
    # numpy is loaded on first use, matplotlib where something is drawn: starting the executable needs neither.
    if find_spec(f"{__name__}.{name}"):
        return import_module(f"{__name__}.{name}")
    api = import_module(f"{__name__}._api")
    if name not in api.__all__:
        raise import_module(f"{__name__}.answers.meant_names").no_attribute(__name__, name, __dir__())
    value = globals()[name] = getattr(api, name)
    return value


def __dir__() -> list[str]:
    return sorted([*import_module(f"{__name__}._api").__all__, "plot", "verify"])
