"""A simulation that the user steps from sample to sample, with snapshots."""

from __future__ import annotations

from sys import getrefcount
from typing import Any

from .. import _native
from .._native import lib
from ..control.law import TORQUE
from ..control.law_state import LawState, read_from, state_of
from ..errors import ControllerError, class_of_outcome
from .run import Run
from .scenario import Scenario


class Snapshot:
    """The whole state of a simulation at an instant. It does not change."""

    def __init__(self, handle: Any, t: float) -> None:
        self._handle = handle
        self._t = t

    def __repr__(self) -> str:
        return f"<Snapshot at t = {self._t:g} s>"


class Simulation:
    """A simulation that waits at each sample of its controller until `step` gives it a torque.

    >>> simulation = Simulation(scenario)
    >>> while not simulation.is_over:
    ...     simulation.step(law(simulation.t, simulation.state))
    >>> run = simulation.run

    That is bit for bit the run of `scenario.run(controller=law)`. The last sample is at time.stop: it ends the run.
    """

    def __init__(self, scenario: Scenario, *, rate: float | None = None) -> None:
        """Start a simulation of a copy of the scenario, whose own controller is not used.

        Args:
            rate: the rate of the samples, Hz; None: the scenario's sampling.rate, by default 1000.

        Raises:
            ScenarioError: the scenario is not valid.
        """
        mine = scenario.for_law(rate)
        mine.warn_of_itself()
        self._file = mine.file
        self._begin(_native.create("simulation", lib.arm3r_simulation_create, mine.handle))

    def _begin(self, handle: Any) -> None:
        self._handle = handle
        self._view = _native.SimulationView(handle)
        self._state = state_of(self._view.memory)

    def _leave_state(self) -> None:
        """A state that the caller has kept takes its numbers with it; any other shows the next sample."""
        if getrefcount(self._state) > 2:  # held by this object and by the call
            read_from(self._state, self._view.memory.copy())
            self._state = state_of(self._view.memory)

    def __repr__(self) -> str:
        return f"<Simulation {self._file}: t = {self.t:g} s{', over' if self.is_over else ''}>"

    @property
    def t(self) -> float:
        """The time of the present sample, s."""
        return self._view.memory.struct.t

    @property
    def state(self) -> LawState:
        """What the controller sees at the present sample; it stays as it is when the simulation goes on."""
        return self._state

    @property
    def is_over(self) -> bool:
        """Whether there is no sample left."""
        return self._view.over[0] != 0

    def step(self, tau: Any) -> None:
        """Apply three torques, N m, from this sample to the next, within arm.torque_limit.

        Raises:
            ControllerError: these are no torques; nothing has happened.
            NumericalError, BudgetError: the run could not go on; `error.run` holds it as far as it came.
            UsageError: the simulation is over, or in use by another thread.
        """
        self._leave_state()
        try:
            status = self._view.advance(tau)
        except _native.NoTorque:
            raise self._refusal(tau) from None
        if status == lib.ARM3R_E_VALUE:
            raise self._refusal(tau)
        if status:
            raise _native.error(status)
        if self._view.over[0] and (run := self.run).outcome != "ok":
            message = f"{self._file}: {run.outcome}: {run.summary['message']}"
            raise class_of_outcome(run.outcome)(message, code=f"run.{run.outcome}", run=run)

    def _refusal(self, tau: Any) -> ControllerError:
        tick, t = self._state.tick, self.t
        message = f"{self._file}: controller: at tick {tick}, t = {t:.12g} s: got {tau!r}; {TORQUE}"
        return ControllerError(message, code="run.controller", tick=tick, t=t, received=tau)

    @property
    def run(self) -> Run:
        """The rows so far: a run whose outcome is `stopped` where it is not over."""
        return Run.of_handle(_native.create("run", lib.arm3r_simulation_run, self._handle))

    def snapshot(self) -> Snapshot:
        """The whole state at the present sample, rows included: the cost grows with their number."""
        return Snapshot(_native.create("simulation", lib.arm3r_simulation_copy, self._handle), self.t)

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot of this or of another simulation of the same scenario. The same bits follow.

        Raises:
            UsageError: it is of another scenario.
        """
        _native.call(lib.arm3r_simulation_restore, self._handle, snapshot._handle)
        self._leave_state()
        self._view.look()

    def copy(self) -> Simulation:
        """An independent simulation at the same sample."""
        copy = Simulation.__new__(Simulation)
        copy._file = self._file
        copy._begin(_native.create("simulation", lib.arm3r_simulation_copy, self._handle))
        return copy

    def __copy__(self) -> Simulation:
        return self.copy()
