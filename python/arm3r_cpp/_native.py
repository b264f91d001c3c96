"""The only module that knows the library: loading, errors, text, arrays, handles, and a run in progress."""

from __future__ import annotations

import atexit
import json
import math
import os
import re
import sys
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import Arm3rError, IncompatibleError, UsageError, class_of


def _check_interpreter() -> None:
    """ImportError: this is a sub-interpreter. What the library calls back there would not arrive."""
    for name in ("_interpreters", "_xxsubinterpreters"):  # the second until Python 3.12
        with suppress(ImportError):
            interpreters = import_module(name)
            if interpreters.get_current() != interpreters.get_main():
                break
    else:
        return
    raise ImportError("arm3r_cpp works in the main interpreter of a process only, and this is a sub-interpreter")


_check_interpreter()
try:
    from ._arm3r import ffi as ffi
    from ._arm3r import lib as lib
except ModuleNotFoundError as missing:
    raise ImportError(
        f"{os.path.dirname(__file__)} holds the sources of arm3r_cpp, not built; `pip install .` builds and installs "
        "it, and Python must then not be started beside them"
    ) from missing

Floats = NDArray[np.float64]


def _check_abi() -> None:
    found, expected = lib.arm3r_abi_version(), lib.ARM3R_ABI
    if found != expected:
        raise IncompatibleError(
            f"libarm3r.so speaks version {found} of the C interface (it is arm3r {version}), the Python extension "
            f"speaks version {expected}; install arm3r_cpp again, and look for another libarm3r.so in "
            f"LD_LIBRARY_PATH={os.getenv('LD_LIBRARY_PATH', '')} and LD_PRELOAD={os.getenv('LD_PRELOAD', '')}",
            status=lib.ARM3R_E_ABI,
            code="abi",
        )


# ---- errors ---------------------------------------------------------------------------------------------------------


def error(status: int, states: States | None = None) -> Arm3rError:
    """The error of this thread's last failed call, which names places in the shapes of the states that were given."""
    report = json.loads(ffi.string(lib.arm3r_error_json()))
    message, problems, index = report["message"], report["problems"], None
    for problem in problems:
        if states and (found := states.find(problem["path"])):
            place, index = found
            message, problem["path"] = message.replace(problem["path"], place), place
    return class_of(status)(message, status=status, code=report["code"], problems=problems, index=index)


def call(function: Callable[..., int], *arguments: Any) -> None:
    """Call a function of the library; raise when it fails."""
    status = function(*arguments)
    if status:
        raise error(status)


# ---- text -----------------------------------------------------------------------------------------------------------


def utf8(text: str, name: str) -> tuple[bytes, int]:
    """Text as the library takes it: bytes and their number. TypeError: it is not text. UsageError: not UTF-8."""
    if not isinstance(text, str):
        raise TypeError(f"{name}: text (str) is needed, got {type(text).__name__}")
    try:
        data = text.encode()
    except UnicodeEncodeError as error:
        raise UsageError(f"{name}: {text!a} is not UTF-8", code="argument.utf8") from error
    return data, len(data)


def file_path(path: str | os.PathLike[str]) -> tuple[bytes, int]:
    """A path as the library takes it."""
    data = os.fsencode(path)
    return data, len(data)


def text(function: Callable[..., int], *arguments: Any) -> str:
    """Call a function whose last argument receives text."""
    out = ffi.new("const char **")
    call(function, *arguments, out)
    return string(out[0])


def string(pointer: Any) -> str:
    return ffi.string(pointer).decode()


def yaml(text: bytes, file: str) -> dict[str, Any]:
    """A YAML file as the library reads it: nodes as arm3r_yaml_json describes them."""
    out = ffi.new("const char **")
    call(lib.arm3r_yaml_json, text, len(text), *utf8(file, "file"), out)
    return json.loads(ffi.string(out[0]))


# ---- handles --------------------------------------------------------------------------------------------------------


def create(kind: str, function: Callable[..., int], *arguments: Any) -> Any:
    """Call a function whose last argument receives a new handle of `arm3r_<kind>`, freed when nothing holds it."""
    out = ffi.new(f"arm3r_{kind} **")
    call(function, *arguments, out)
    return ffi.gc(out[0], getattr(lib, f"arm3r_{kind}_free"))


# ---- arrays ---------------------------------------------------------------------------------------------------------


def reals(value: Any, name: str) -> Floats:
    """`value` as float64, C-contiguous and aligned, itself where it is. TypeError: not real numbers."""
    if np.ma.isMaskedArray(value):
        raise TypeError(f"{name}: a masked array has holes; fill them first")
    array = np.asarray(value)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: real numbers are needed, got an array of {array.dtype}")
    return np.require(array, np.float64, ["C", "A"])


def check_finite(array: Floats, name: str) -> None:
    """ValueError: not finite."""
    good = np.isfinite(array)
    if not good.all():
        index = tuple(int(i) for i in np.argwhere(~good)[0])
        raise ValueError(f"{name}{_brackets(index)}: a finite number is needed, got {array[index]}")


def _brackets(index: Iterable[int]) -> str:
    return "".join(f"[{i}]" for i in index)


class States:
    """Arrays (..., 3), broadcast over their leading axes, as the library takes them: n states in a row."""

    def __init__(self, **values: Any) -> None:
        """TypeError, ValueError: not real numbers, or of shapes that do not fit. f_on_tip may be None."""
        given = {name: value for name, value in values.items() if name != "f_on_tip" or value is not None}
        self._arrays = arrays = {name: reals(value, name) for name, value in given.items()}
        for name, array in arrays.items():
            if array.ndim == 0 or array.shape[-1] != 3:
                raise ValueError(f"{name}: the shape (..., 3) is needed, got {array.shape}")
        self._shapes = {name: array.shape[:-1] for name, array in arrays.items()}
        try:
            self.leading = np.broadcast_shapes(*self._shapes.values())
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
            raise ValueError(f"the leading axes do not broadcast: {shapes}") from None
        full = {name: np.ascontiguousarray(np.broadcast_to(a, (*self.leading, 3))) for name, a in arrays.items()}
        self._pointers = [readable(full[name]) if name in full else ffi.NULL for name in values]

    def call(self, function: Callable[..., int], handle: Any, *arguments: Any) -> None:
        """Call a function that takes a handle, n, the states, and more. ValueError: not finite."""
        n = math.prod(self.leading)
        status = function(handle, n, *self._pointers, *arguments)
        if status or n == 0:  # the library looks at every number, but cannot tell it as the caller gave it
            for name, array in self._arrays.items():
                check_finite(array, name)
        if status:
            raise error(status, self)

    def find(self, path: str) -> tuple[str, tuple[int, ...]] | None:
        """The library's "q[7][1]", of state 7 of n, as the caller counts, "q[3][1][1]"; and that state's index."""
        found = re.fullmatch(r"(\w+)(.*?)\[(\d+)\](.*)", path)
        if not found:
            return None
        name, note, state, component = found.groups()
        name = name if name in self._shapes else next(iter(self._shapes))  # tip, of inverse_kinematics(p)
        index = tuple(int(i) for i in np.unravel_index(int(state), self.leading)) if self.leading else ()
        own = self._shapes[name]
        place = (0 if size == 1 else i for i, size in zip(index[len(index) - len(own) :], own, strict=True))
        return f"{name}{_brackets(place)}{component}{note}", index


def readable(array: Floats) -> Any:
    """A pointer to an array's numbers; it keeps the array alive."""
    if array.dtype != np.float64 or not array.flags.c_contiguous or not array.flags.aligned:
        raise TypeError(f"a contiguous float64 array is needed, got {array.dtype} with strides {array.strides}")
    return ffi.from_buffer("double[]", array)


def writable(array: Floats) -> Any:
    """The same, to be written through."""
    if not array.flags.writeable:
        raise TypeError("a writable array is needed")
    return readable(array)


class _Block:
    """Memory of a run, as numpy takes it: read-only, kept alive by any view of it. A column of the run is a row."""

    def __init__(self, run: Any, data: Any, shape: tuple[int, int], stride: int) -> None:
        self._run = run
        address = int(ffi.cast("uintptr_t", data))
        self.__array_interface__ = {
            "version": 3,
            "typestr": "=f8",
            "shape": shape,
            "strides": (8 * stride, 8),
            "data": (address, True),
        }


# ---- runs -----------------------------------------------------------------------------------------------------------

Progress = Callable[[float, float, int], Any]
BatchProgress = Callable[[int, int], Any]


_ENDING_TAKES = 0.8  # s, at most


class _Interpreter:
    """Its end. A daemon thread that then calls back into Python is killed there, so its runs are stopped before.

    Attributes:
        stop: the stop flag of all runs of daemon threads.
        busy: those that are in progress.
    """

    def __init__(self) -> None:
        self.stop = ffi.new("int32_t *")
        self.busy: set[_InProgress] = set()
        atexit.register(self.end)
        if sys.platform != "win32":
            os.register_at_fork(after_in_child=self.busy.clear)  # the child has one thread

    def end(self) -> None:
        """Stop the runs, and wait until their threads have seen it."""
        self.stop[0] = 1
        deadline = time.monotonic() + _ENDING_TAKES
        while self.busy and time.monotonic() < deadline:
            time.sleep(0.001)

    def enter(self, call: _InProgress) -> None:
        if threading.current_thread().daemon:
            self.busy.add(call)

    def leave(self, call: _InProgress) -> None:
        """A thread whose run was stopped by the end of the interpreter waits here for its own end."""
        self.busy.discard(call)
        if self.stop[0] and threading.current_thread().daemon:
            threading.Event().wait()

    def stop_flag(self) -> Any:
        """Of a call of this thread. Other threads than daemons have ended before the interpreter does."""
        return self.stop if threading.current_thread().daemon else ffi.NULL


_interpreter = _Interpreter()


class _InProgress:
    """While the library calls `progress`, of one run or one batch, or a law. What they raise comes out again."""

    def __init__(self, progress: Callable[..., Any] | None, law: Any = None) -> None:
        self.progress = progress
        self.law = law
        self.raised: BaseException | None = None
        self.stop = ffi.new("int32_t *")

    def __enter__(self) -> None:
        self._outer, _here.call = getattr(_here, "call", None), self
        _interpreter.enter(self)

    def __exit__(self, kind: Any, raised: BaseException | None, traceback: Any) -> None:
        _here.call = self._outer
        _interpreter.leave(self)
        if self.raised is not None and isinstance(raised, Arm3rError):
            raise self.raised from None


_here = threading.local()  # .call: this thread's run in progress


def _keep(kind: type[BaseException], raised: BaseException, traceback: Any) -> None:
    _here.call.raised = raised.with_traceback(traceback)
    _here.call.stop[0] = 1


def _called_by_the_library(kind: str) -> Callable[[Callable[..., int]], Any]:
    """Makes a function of Python one of the C type `kind`: compiled with the extension, or without one, here."""

    def make(function: Callable[..., int]) -> Any:
        if not hasattr(lib, function.__name__):
            return ffi.callback(kind, function, error=-1, onerror=_keep)
        ffi.def_extern(error=-1, onerror=_keep)(function)
        return getattr(lib, function.__name__)

    return make


@_called_by_the_library("arm3r_progress")
def arm3r_python_progress(user: Any, t: float, stop: float, steps: int) -> int:
    # Entering a Python function is what lets signal handlers run: this is how Ctrl-C ends a run.
    progress = _here.call.progress
    return int(progress is not None and bool(progress(t, stop, steps)))


def start(
    function: Callable[..., int],
    *arguments: Any,
    progress: Progress | None,
    time_limit: float | None,
    trust: bool = False,
) -> Any:
    """A run by a function whose last arguments are options and the new run. What `progress` raises comes out again."""
    options = _run_options(time_limit)
    options.trust = trust
    with _InProgress(progress):
        return create("run", function, *arguments, options)


def _run_options(time_limit: float | None) -> Any:
    options = ffi.new("arm3r_run_options *")
    options.struct_size = ffi.sizeof("arm3r_run_options")
    options.stop = _interpreter.stop_flag()
    options.progress = arm3r_python_progress
    options.time_limit = 0.0 if time_limit is None else time_limit
    return options


@cache
def column_places() -> dict[str, int]:
    """Every column that some run can have, and its place in arm3r_columns_text."""
    lines = string(lib.arm3r_columns_text()).splitlines()
    return {line.split()[0]: place for place, line in enumerate(lines)}


def outcome(run: Any) -> str:
    out = ffi.new("int32_t *")
    call(lib.arm3r_run_outcome, run, out)
    return outcome_name(out[0])


def nearest_word(word: str, words: Iterable[str]) -> str:
    """The one of `words` that `word` is most likely a slip for; "" where none is near."""
    names = list(words)
    texts = [ffi.new("char[]", name.encode()) for name in names]
    place = ffi.new("int64_t *")
    call(lib.arm3r_nearest_word, word.encode(errors="replace"), texts, len(texts), place)
    return names[place[0]] if place[0] >= 0 else ""


def outcome_name(number: int) -> str:
    """ "ok", "stopped", ...; "" of an unknown one."""
    return string(lib.arm3r_outcome_name(number))


@_called_by_the_library("arm3r_batch_progress")
def arm3r_python_batch_progress(user: Any, runs_done: int, runs: int) -> int:
    progress = _here.call.progress
    return int(progress is not None and bool(progress(runs_done, runs)))


@_called_by_the_library("arm3r_law")
def arm3r_python_batch_law(user: Any, state: Any, tau: Any) -> int:
    call = _here.call
    call.stop[0] |= _interpreter.stop[0]
    return call.law(int(ffi.cast("uintptr_t", user)), state, tau)


def batch(
    params: Floats,
    varied: list[int],
    values: Floats,
    *,
    threads: int | None,
    progress: BatchProgress | None,
    law: Any = None,
    rows: tuple[Sequence[str], Floats] | None = None,
    metrics: Sequence[str] | None = None,
) -> tuple[Floats, BaseException | None]:
    """The table of (varied, runs) values in the places of the varied numbers, (columns, runs); and what a law raised.

    law: None, in machine code (NativeLaw), or called as law(run, state, tau). If it raises, no other run is begun.
    rows: names of columns, and the array (runs, columns, rows) that is to be filled with them.
    metrics: the names of the table's columns; None: all of `summary_columns()`.
    """
    known = list(summary_columns())
    wanted = [known.index(name) for name in (known if metrics is None else metrics)]
    results = np.empty((len(wanted), values.shape[1]))
    given = _variation(params, varied, values)
    here = _InProgress(progress, law)
    options = ffi.new("arm3r_batch_options *")
    options.struct_size = ffi.sizeof("arm3r_batch_options")
    options.stop = here.stop if callable(law) else _interpreter.stop_flag()
    options.progress = arm3r_python_batch_progress
    options.threads = threads or 0
    memory, _kept = _batch_rows(*rows) if rows else (ffi.NULL, None)
    options.rows = memory
    summary = ffi.new("size_t[]", wanted or 1)
    options.summary, options.summary_size = summary, len(wanted)
    with here:
        if law is None:
            call(lib.arm3r_batch_run, *given, options, writable(results))
        else:
            call(lib.arm3r_batch_control, *given, _batch_law(law), options, writable(results))
    return results, here.raised


def batch_row_count(params: Floats, varied: list[int], values: Floats, columns: Sequence[str]) -> int:
    """The most rows that a run of the batch can have. ScenarioError: no run has one of the columns."""
    count = ffi.new("size_t *")
    call(lib.arm3r_batch_row_count, *_variation(params, varied, values), _places(columns), len(columns), count)
    return int(count[0])


def _variation(params: Floats, varied: list[int], values: Floats) -> list[Any]:
    places = ffi.new("size_t[]", varied or 1)
    return [readable(params), params.size, places, len(varied), readable(values), values.shape[1]]


def _places(columns: Sequence[str]) -> Any:
    return ffi.new("size_t[]", [column_places()[name] for name in columns] or 1)


def _batch_rows(columns: Sequence[str], block: Floats) -> tuple[Any, Any]:
    """An arm3r_batch_rows, and what must live as long as it does."""
    rows, places = ffi.new("arm3r_batch_rows *"), _places(columns)
    rows.struct_size = ffi.sizeof("arm3r_batch_rows")
    rows.columns, rows.column_count, rows.row_count = places, len(columns), block.shape[2]
    rows.data = writable(block)
    return rows, places


def _batch_law(law: Any) -> Any:
    struct = ffi.new("arm3r_batch_law *")
    struct.struct_size = ffi.sizeof("arm3r_batch_law")
    if callable(law):
        struct.function, struct.user_stride = arm3r_python_batch_law, 1  # `user` is the number of the run
    else:
        struct.function = ffi.cast("arm3r_law", int(law.address))
        struct.user = ffi.cast("void *", int(law.user))
        struct.user_stride, struct.reentrant = int(law.stride), int(law.reentrant)
    return struct


@cache
def summary_columns() -> dict[str, str]:
    """Units of a batch's columns, by name."""
    name, unit, meaning = (ffi.new("const char **") for _ in range(3))
    units = {}
    for index in range(lib.arm3r_summary_count()):
        call(lib.arm3r_summary_column, index, name, unit, meaning)
        units[string(name[0])] = string(unit[0])
    return units


# ---- control laws of the user's own ---------------------------------------------------------------------------------


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
    law = _here.call.law
    put_torque(law.answer(t), law.memory.torque)
    return 0


def _law_in_python() -> Any:
    """The arm3r_law that calls `arm3r_python_tick`: compiled with the extension, or without one, made here."""
    if hasattr(lib, "arm3r_python_tick"):
        ffi.def_extern(error=-1, onerror=_keep)(arm3r_python_tick)
        return ffi.addressof(lib, "arm3r_python_law")

    def law(user: Any, state: Any, tau: Any) -> int:
        struct, torque = ffi.cast("void **", user)[0:2]
        ffi.memmove(struct, state, ffi.sizeof("arm3r_law_state"))
        status = arm3r_python_tick(state.t)
        ffi.memmove(tau, torque, ffi.sizeof("double[3]"))
        return status

    return ffi.callback("arm3r_law", law, error=-1, onerror=_keep)


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
    here = _InProgress(progress, law)
    with here:
        run = create("run", lib.arm3r_scenario_control, scenario, given, user, _run_options(time_limit))
    return run, here.raised


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


def _column_unit(run: Any, index: int) -> str:
    name, unit, data = ffi.new("const char **"), ffi.new("const char **"), ffi.new("const double **")
    call(lib.arm3r_run_column, run, index, name, unit, data)
    return string(unit[0])


_layouts: dict[bytes, tuple[list[str], dict[str, str]]] = {}  # by "t,q1,q2": the names, and the unit of each


def _layout(run: Any, names: bytes) -> tuple[list[str], dict[str, str]]:
    if names not in _layouts:
        columns = names.decode().split(",")
        _layouts[names] = columns, {name: _column_unit(run, index) for index, name in enumerate(columns)}
    return _layouts[names]


def columns(run: Any) -> tuple[dict[str, Floats], dict[str, str]]:
    """Values and units of a run's columns, by name; the values are views of the run's own memory."""
    sizes = ffi.new("size_t[3]")  # rows, columns, stride
    data, text = ffi.new("const double **"), ffi.new("const char **")
    call(lib.arm3r_run_shape, run, sizes, sizes + 1)
    call(lib.arm3r_run_block, run, data, sizes + 2, text)
    rows, count, stride = sizes
    names, units = _layout(run, ffi.string(text[0]))
    block = np.asarray(_Block(run, data[0], (count, rows), stride))
    return dict(zip(names, block, strict=True)), dict(units)


version = string(lib.arm3r_version())
_check_abi()
