"""Control laws of the user's own: the memory that they share with the library, and simulations that are stepped."""

from __future__ import annotations

from typing import Any

import numpy as np

from .calls import call, create
from .library import Floats, ffi, lib
from .progress import InProgress, Progress, keep, this_thread
from .runs import run_options

_ndarray, _float64 = np.ndarray, np.dtype(np.float64)  # found faster


class NoTorque(Exception):
    """Raised where what a law returned is not three numbers."""


def put_torque(torque: Any, out: Any) -> None:
    """Write three numbers where the library reads a torque. NoTorque: they are not. It looks itself at their values."""
    kind = type(torque)
    if kind is _ndarray and torque.dtype is _float64:
        torque = torque.tolist()
    elif isinstance(torque, _ndarray):
        if torque.dtype.kind not in "fiu":
            raise NoTorque
        torque = torque.tolist()
    elif kind is not tuple and kind is not list and not isinstance(torque, (list, tuple)):
        raise NoTorque
    try:
        out[0], out[1], out[2] = torque
    except (TypeError, ValueError, OverflowError):
        raise NoTorque from None


def _as_doubles(array: Any) -> memoryview[float]:
    """An array of the library's type as one of Python's, which takes numbers in two thirds of the time."""
    return memoryview(ffi.buffer(array)).cast("d")


_STATE_ARRAYS = {
    name: (field.offset, field.type.length)
    for name, field in ffi.typeof("arm3r_law_state").fields
    if field.type.kind == "array"
}


class StateMemory:
    """An arm3r_law_state: `struct` for its single numbers; the others as arrays, views of it, by name."""

    def __init__(self, struct: Any) -> None:
        self.struct = struct

    def copy(self) -> StateMemory:
        """The same numbers in a memory of their own."""
        struct = ffi.new("arm3r_law_state *")
        ffi.memmove(struct, self.struct, ffi.sizeof("arm3r_law_state"))
        return StateMemory(struct)

    def __getattr__(self, name: str) -> Floats:
        if name not in _STATE_ARRAYS:
            raise AttributeError(f"arm3r_law_state has no array {name!r}")
        offset, size = _STATE_ARRAYS[name]
        view = np.frombuffer(ffi.buffer(self.struct), np.float64, size, offset)
        view = self.__dict__[name] = view.reshape(3, 3) if size == 9 else view
        return view


def state_index() -> dict[str, int]:
    """The place of each number, or of its first one, in an arm3r_law_state taken as doubles."""
    fields = ffi.typeof("arm3r_law_state").fields
    return {name: field.offset // 8 for name, field in fields if name != "struct_size"}


class LawMemory:
    """What the library and a law in Python share: its state at a sample, and the torque that it answers.

    Attributes:
        state: the state.
        torque: where the torque is put.
        user: what the library is given with the law.
    """

    def __init__(self) -> None:
        self._struct, self._tau = ffi.new("arm3r_law_state *"), ffi.new("double[3]")
        self.state, self.torque = StateMemory(self._struct), _as_doubles(self._tau)
        self.user = ffi.new("void *[2]", [self._struct, self._tau])


def arm3r_python_tick(t: float) -> int:
    law = this_thread.call.law
    put_torque(law.answer(t), law.memory.torque)
    return 0


def _law_in_python() -> Any:
    """The arm3r_law that calls `arm3r_python_tick`: compiled with the extension, or without one, made here."""
    if hasattr(lib, "arm3r_python_tick"):
        ffi.def_extern(error=-1, onerror=keep)(arm3r_python_tick)
        return ffi.addressof(lib, "arm3r_python_law")

    def law(user: Any, state: Any, tau: Any) -> int:
        struct, torque = ffi.cast("void **", user)[0:2]
        ffi.memmove(struct, state, ffi.sizeof("arm3r_law_state"))
        status = arm3r_python_tick(state.t)
        ffi.memmove(tau, torque, ffi.sizeof("double[3]"))
        return status

    return ffi.callback("arm3r_law", law, error=-1, onerror=keep)


_python_law = _law_in_python()


def control(
    scenario: Any, law: Any, *, progress: Progress | None, time_limit: float | None
) -> tuple[Any, BaseException | None]:
    """A run with a law in Python or, with an `address`, in machine code; and what it raised.

    One in Python has a `memory`: law.answer(t) returns the torque for the state that stands there.
    """
    native = hasattr(law, "address")
    given = ffi.cast("arm3r_law", int(law.address)) if native else _python_law
    user = ffi.cast("void *", int(law.user)) if native else law.memory.user
    running = InProgress(progress, law)
    with running:
        run = create("run", lib.arm3r_scenario_control, scenario, given, user, run_options(time_limit))
    return run, running.raised


class SimulationView:
    """What is seen of a simulation at its present sample. It is renewed in place.

    Attributes:
        memory: the state.
        over: over[0] is not 0 when no sample is left.
    """

    def __init__(self, simulation: Any) -> None:
        self._simulation = simulation
        self._struct, self._tau = ffi.new("arm3r_law_state *"), ffi.new("double[3]")
        self._torque = _as_doubles(self._tau)
        self.memory, self.over = StateMemory(self._struct), ffi.new("int32_t *")
        self.look()

    def look(self) -> None:
        call(lib.arm3r_simulation_state, self._simulation, self._struct)
        call(lib.arm3r_simulation_is_over, self._simulation, self.over)

    def advance(self, torque: Any) -> int:
        """Apply a torque until the next sample; the status of the library. NoTorque: it is not three numbers."""
        put_torque(torque, self._torque)
        return lib.arm3r_simulation_advance(self._simulation, self._tau, self._struct, self.over)
