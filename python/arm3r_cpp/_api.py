"""Every public name of the package."""

from ._native import version as __version__
from .arm import Arm
from .batch import Batch
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
from .params import ParamKey, param_count, param_defaults, param_index, param_key, param_name
from .run import Event, Run
from .scenario import Scenario
from .sweep_file import Sweep
from .sweep_run import sweep
from .sweep_table import SweepTable

__all__ = [
    "Arm",
    "Arm3rError",
    "Batch",
    "BudgetError",
    "ControllerError",
    "Event",
    "IncompatibleError",
    "InternalError",
    "NumericalError",
    "OutputError",
    "ParamKey",
    "Run",
    "Scenario",
    "ScenarioError",
    "Sweep",
    "SweepTable",
    "UsageError",
    "__version__",
    "param_count",
    "param_defaults",
    "param_index",
    "param_key",
    "param_name",
    "sweep",
]
