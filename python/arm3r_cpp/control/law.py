"""Control laws that users write, as `Scenario.run` takes them."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from contextlib import nullcontext
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from .. import _native
from ..errors import BudgetError, ControllerError, UsageError
from .law_state import OVER, LawState, read_from
from .time_limit import TimeLimit, TimeLimitReached

Law = Callable[[float, LawState], Any]

ADDRESS_BITS = 8 * ctypes.sizeof(ctypes.c_void_p)


class NativeLaw(NamedTuple):
    """A law in machine code: a function `int32_t law(void *user, const arm3r_law_state *state, double *tau)`.

    >>> scenario.run(controller=NativeLaw(cfunc.address, gains.ctypes.data))
    """

    address: int
    """The address of the function; the caller keeps the function alive."""
    user: int = 0
    """The address that the function gets as its first argument."""
    stride: int = 0
    """In a batch, run i gets the address user + i*stride, bytes; i counts in the order of `ravel`."""
    reentrant: bool = False
    """In a batch, whether several threads may call the function at the same time, each for a run of its own."""


def law_state_index() -> dict[str, int]:
    """Where each number stands in arm3r_law_state taken as an array of doubles: {"q": 4, ...}, for a NativeLaw."""
    return _native.state_index()


class LawAdapter:
    """Asks a law at each sample, and keeps what the message of an error needs. `state`: where its state stands."""

    def __init__(self, law: Law, state: _native.StateMemory) -> None:
        self.law = law
        self._memory = state
        self._first: float | None = None
        self._period = 1.0
        self.t = 0.0
        self.received: Any = None

    def answer(self, t: float) -> Any:
        """What the law returns for the state of the sample at t, s."""
        if self._first is None:
            self._first, self._period = t, self._memory.struct.period
        self.t = t
        self.received = None
        state = LawState()
        read_from(state, self._memory)
        try:
            self.received = received = self.law(t, state)
        finally:
            read_from(state, OVER)
        return received

    @property
    def tick(self) -> int:
        """The number of the last tick."""
        return round((self.t - (self._first or 0.0)) / self._period)


class _SingleLaw(LawAdapter):
    """The law of a single run, with the memory that it shares with the library."""

    def __init__(self, law: Law) -> None:
        self.memory = _native.LawMemory()
        super().__init__(law, self.memory.state)


class Ended(Protocol):
    """What is asked of a run."""

    @property
    def outcome(self) -> str: ...


AnyRun = TypeVar("AnyRun", bound=Ended)


def run_with_law(
    handle: Any,
    controller: Law | NativeLaw,
    file: str,
    run_of: Callable[[Any], AnyRun],
    *,
    progress: _native.Progress | None,
    time_limit: float | None,
) -> AnyRun:
    """Run a scenario's handle with a law. ControllerError, BudgetError: as Scenario.run says.

    Args:
        run_of: makes the run of its handle.
    """
    if isinstance(controller, NativeLaw):
        check_native(controller)
        run, _ = _native.control(handle, controller, progress=progress, time_limit=time_limit)
        return run_of(run)
    if not callable(controller):
        raise UsageError(f"controller: a function of (t, state) is needed, got {controller!r}", code="usage")
    limit = None if time_limit is None else TimeLimit(controller, time_limit)
    adapter = _SingleLaw(limit or controller)
    with limit or nullcontext():
        run, raised = _native.control(handle, adapter, progress=progress, time_limit=time_limit)
    if raised is not None and not isinstance(raised, (Exception, TimeLimitReached)):
        raise raised
    ended = run_of(run)
    if raised is None and ended.outcome != "controller":
        return ended
    raise _failure(adapter, controller, raised, ended, file, time_limit) from cause_of(raised)


def cause_of(raised: BaseException | None) -> BaseException | None:
    return None if isinstance(raised, (_native.NoTorque, TimeLimitReached)) else raised


def _failure(
    adapter: LawAdapter, controller: Law, raised: BaseException | None, run: Ended, file: str, time_limit: float | None
) -> BudgetError | ControllerError:
    tick = adapter.tick
    place = f"at tick {tick}, t = {adapter.t:.12g} s"
    if isinstance(raised, TimeLimitReached):
        why = f"the time limit of {time_limit:g} s is used up in the controller {name_of(controller)} {place}"
        return BudgetError(f"{file}: budget: {why}", code="run.budget", run=run)
    return ControllerError(
        f"{file}: controller: {place}: {why_it_failed(adapter, controller, raised)}",
        code="run.controller",
        run=run,
        tick=tick,
        t=adapter.t,
        received=adapter.received,
    )


def name_of(function: Any) -> str:
    return getattr(function, "__qualname__", repr(function))


def why_it_failed(adapter: LawAdapter, controller: Law, raised: BaseException | None) -> str:
    """A law may have a sentence of its own: law.why_it_failed(raised, received)."""
    if own := getattr(controller, "why_it_failed", None):
        return own(cause_of(raised), adapter.received)
    if cause_of(raised) is not None:
        return f"{name_of(controller)} raised {type(raised).__name__}: {raised}"
    return f"{name_of(controller)} returned {adapter.received!r}; {TORQUE}"


TORQUE = "three finite numbers (list, tuple, array) are needed, N m, at most 1e12 either way"


def check_native(law: NativeLaw) -> None:
    """TypeError: not integers. ValueError: no addresses of this machine, or a stride that no array has."""
    _check_address("NativeLaw.address", law.address)
    _check_address("NativeLaw.user", law.user)
    _check_address("NativeLaw.stride", law.stride)
    if not isinstance(law.reentrant, (bool, np.bool_)):
        raise TypeError(f"NativeLaw.reentrant: True or False is needed, got {law.reentrant!r}")


def _check_address(name: str, address: object) -> None:
    """TypeError: not an integer. ValueError: no address of this machine."""
    if isinstance(address, bool) or not isinstance(address, (int, np.integer)):
        raise TypeError(f"{name}: an address (int) is needed, got {address!r}")
    if not 0 <= address < 2**ADDRESS_BITS:
        raise ValueError(f"{name}: an address has {ADDRESS_BITS} bits, got {address}")


def check_time_limit(seconds: float | None) -> None:
    """TypeError: not a number. ValueError: not a positive one."""
    if isinstance(seconds, bool):
        raise TypeError(f"time_limit: a number of seconds is needed, got {seconds}")
    if seconds is not None and not 0 < seconds < math.inf:
        raise ValueError(f"time_limit: a positive number of seconds is needed, got {seconds}")


def check_rate(rate: float) -> None:
    """ValueError: not a positive number."""
    if not 0 < rate < math.inf:
        raise ValueError(f"rate: a positive number of Hz is needed, got {rate}")
