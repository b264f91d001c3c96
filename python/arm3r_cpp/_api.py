"""Every public name of the package."""

from ._native import version as __version__
from .arm import Arm
from .errors import (
    Arm3rError,
    BudgetError,
    ControllerError,
    IncompatibleError,
    InternalError,
    NumericalError,
    OutputError,
    ScenarioError,
    UsageError,
)
from .params import param_count, param_defaults, param_index, param_name
from .run import Event, Run
from .scenario import Scenario

__all__ = [
    "Arm",
    "Arm3rError",
    "BudgetError",
    "ControllerError",
    "Event",
    "IncompatibleError",
    "InternalError",
    "NumericalError",
    "OutputError",
    "Run",
    "Scenario",
    "ScenarioError",
    "UsageError",
    "__version__",
    "param_count",
    "param_defaults",
    "param_index",
    "param_name",
]
