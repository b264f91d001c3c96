"""Every public name of the package. What sweeps need is loaded when it is asked for."""

from __future__ import annotations

from importlib import import_module

from ._native import version as __version__
from .control.law import NativeLaw, law_state_index
from .control.law_state import LawState
from .core.arm import Arm
from .core.batch import Batch
from .core.params import ParamKey, param_count, param_defaults, param_index, param_key, param_name
from .core.run import ClosedForm, Event, Run, Trust
from .core.scenario import Scenario
from .core.simulation import Simulation, Snapshot
from .errors import (
    Arm3rError,
    BudgetError,
    ColumnError,
    ControllerError,
    IncompatibleError,
    InternalError,
    NumericalError,
    OutputError,
    ScenarioError,
    ScenarioWarning,
    UnjudgedError,
    UsageError,
)

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .accuracy.convergence import Convergence, converge
    from .interchange.export import export
    from .live.show import show
    from .sweeps.definition import Sweep
    from .sweeps.runner import sweep
    from .sweeps.table import SweepTable

_LATER = {
    "Convergence": "accuracy.convergence",
    "Sweep": "sweeps.definition",
    "SweepTable": "sweeps.table",
    "converge": "accuracy.convergence",
    "export": "interchange.export",
    "show": "live.show",
    "sweep": "sweeps.runner",
}


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_LATER[name]}", __package__), name)


__all__ = [
    "Arm",
    "Arm3rError",
    "Batch",
    "BudgetError",
    "ClosedForm",
    "ColumnError",
    "ControllerError",
    "Convergence",
    "Event",
    "IncompatibleError",
    "InternalError",
    "LawState",
    "NativeLaw",
    "NumericalError",
    "OutputError",
    "ParamKey",
    "Run",
    "Scenario",
    "ScenarioError",
    "ScenarioWarning",
    "Simulation",
    "Snapshot",
    "Sweep",
    "SweepTable",
    "Trust",
    "UnjudgedError",
    "UsageError",
    "__version__",
    "converge",
    "export",
    "law_state_index",
    "param_count",
    "param_defaults",
    "param_index",
    "param_key",
    "param_name",
    "show",
    "sweep",
]
