"""The C interface against misuse, driven by the header's own declarations."""

from __future__ import annotations

import json
import math
import re
import subprocess
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp._arm3r import ffi, lib

HEADER = Path(arm3r.__file__).parent / "include" / "arm3r" / "arm3r.h"
SCENARIO = b"format: 1\ntime: {stop: 0.05}\nwall: {point: [1.7, 0, 0]}\n"  # in contact from the start: it has an event
SWEEP = b"format: 1\nscenario: {}\naxes: [{key: time.stop, values: [1, 2]}]\n"
CONTROLLED = SCENARIO + b"controller: {type: user}\n"
USER = arm3r.Scenario(CONTROLLED.decode()).params[arm3r.param_index("controller.type")]
SIZE_MAX = 2 ** (8 * ffi.sizeof("size_t")) - 1


# ---- the declarations -----------------------------------------------------------------------------------------------


CALLBACKS = ("arm3r_progress", "arm3r_batch_progress", "arm3r_sink", "arm3r_law", "arm3r_arm_reader")


@dataclass(frozen=True)
class Argument:
    type: str
    name: str
    nullable: bool

    @property
    def is_pointer(self) -> bool:
        return "*" in self.type or self.type in CALLBACKS


@dataclass(frozen=True)
class Function:
    name: str
    result: str
    arguments: tuple[Argument, ...]

    def index(self, name: str) -> int:
        return [argument.name for argument in self.arguments].index(name)


def _argument(text: str, nullable: bool) -> Argument:
    words = re.fullmatch(r"(.*?)(\w+)", re.sub(r"/\*.*?\*/", "", text).strip())
    return Argument(words[1].strip(), words[2], nullable or "Nullable" in text)


def _functions() -> list[Function]:
    found = []
    for match in re.finditer(r"^ARM3R_API ([^;(]*?)(arm3r_\w+)\(([^;]*?)\);(.*)$", HEADER.read_text(), re.M):
        result, name, arguments, note = match.groups()
        parts = [] if arguments == "void" else re.split(r",(?![^/]*\*/)", arguments)
        alone = len(parts) == 1 and note.strip().startswith("/* Nullable")
        found.append(Function(name, result.strip(), tuple(_argument(part, alone) for part in parts)))
    return found


FUNCTIONS = _functions()
FALLIBLE = [function for function in FUNCTIONS if function.result == "int32_t" and function.arguments[1:]]
BATCHED = [function for function in FALLIBLE if any(argument.name == "n" for argument in function.arguments)]


class Caller:
    """Makes good arguments for any function, by type and name. What it makes stays alive as long as it does."""

    def __init__(self, folder: Path) -> None:
        self.kept: list[Any] = []
        self.scenario_file = folder / "abi.yaml"
        self.scenario_file.write_bytes(SCENARIO)
        self.output = folder / "abi.csv"
        self.count = lib.arm3r_param_count()

    def __call__(self, function: Function, **replaced: Any) -> Any:
        arguments = {a.name: self.argument(function, a) for a in function.arguments}
        assert replaced.keys() <= arguments.keys()
        return getattr(lib, function.name)(*{**arguments, **replaced}.values())

    def keep(self, thing: Any) -> Any:
        self.kept.append(thing)
        return thing

    def argument(self, function: Function, argument: Argument) -> Any:
        kind, name = argument.type, argument.name
        if name.endswith("_size"):
            return len(self.text(function, name.removesuffix("_size")))
        if kind == "const char *":
            return self.keep(ffi.new("char[]", self.text(function, name)))
        if name == "words":
            word = self.keep(ffi.new("char[]", b"length"))
            return self.keep(ffi.new("const char *[]", [word] * self.count))
        if name == "params":
            return self.params("user" if function.name.endswith("_control") else "none")
        if kind == "const double *":
            return self.keep(ffi.new("double[]", [1.2, -0.5, 0.9]))
        if kind == "double *":
            return self.keep(ffi.new("double[64]"))
        if kind.endswith("**"):
            return self.keep(ffi.new(kind))
        if handle := re.fullmatch(r"(?:const )?arm3r_(arm|scenario|run|simulation) \*", kind):
            controlled = function.name in ("arm3r_scenario_control", "arm3r_simulation_create")
            return self.scenario(CONTROLLED) if controlled else getattr(self, handle[1])()
        if kind == "arm3r_law":
            return self.keep(ffi.callback("int32_t(void *, const arm3r_law_state *, double *)", _hold))
        if kind == "arm3r_arm_reader":
            return lib.arm3r_python_arm_reader  # the package's own: it stays for all tests that follow
        if kind == "arm3r_sink":
            return self.keep(ffi.callback("int32_t(void *, const char *, size_t)", lambda user, data, size: 0))
        if kind == "const arm3r_batch_law *":
            law = self.options("arm3r_batch_law")
            law.function = self.argument(function, Argument("arm3r_law", name, False))
            return law
        if options := re.fullmatch(r"const (arm3r_\w+_options) \*", kind):
            return self.options(options[1])
        if kind == "void *":
            return ffi.NULL
        if kind.endswith("*"):
            return self.keep(ffi.new(kind))
        return {"count": self.count, "n": 1}.get(name, 0)

    def text(self, function: Function, name: str) -> bytes:
        if name == "path":
            return {
                "arm3r_scenario_load": bytes(self.scenario_file),
                "arm3r_run_save": bytes(self.output),
                "arm3r_output_probe": bytes(self.output),
            }.get(function.name, b"time.stop")
        if (function.name, name) == ("arm3r_sweep_read", "text"):
            return SWEEP
        return {"text": SCENARIO, "word": b"lenght", "file": b"abi.yaml", "name": b"initial.q[0]", "value": b"0.1"}[
            name
        ]

    def params(self, controller: str) -> Any:
        values = self.keep(ffi.new("double[]", self.count))
        assert lib.arm3r_param_defaults(values, self.count) == 0
        if controller == "user":
            values[arm3r.param_index("controller.type")] = USER
        return values

    def options(self, kind: str = "arm3r_run_options") -> Any:
        options = self.keep(ffi.new(f"{kind} *"))
        options.struct_size = ffi.sizeof(kind)
        return options

    def arm(self) -> Any:
        out = ffi.new("arm3r_arm **")
        assert lib.arm3r_arm_create(self.params("none"), self.count, out) == 0, message()
        return self.keep(ffi.gc(out[0], lib.arm3r_arm_free))

    def scenario(self, text: bytes = SCENARIO) -> Any:
        out = ffi.new("arm3r_scenario **")
        assert lib.arm3r_scenario_create(text, len(text), b"abi.yaml", 8, out) == 0, message()
        return self.keep(ffi.gc(out[0], lib.arm3r_scenario_free))

    def simulation(self) -> Any:
        out = ffi.new("arm3r_simulation **")
        assert lib.arm3r_simulation_create(self.scenario(CONTROLLED), out) == 0, message()
        return self.keep(ffi.gc(out[0], lib.arm3r_simulation_free))

    def run(self) -> Any:
        out = ffi.new("arm3r_run **")
        assert lib.arm3r_scenario_run(self.scenario(), ffi.NULL, out) == 0, message()
        return self.keep(ffi.gc(out[0], lib.arm3r_run_free))


def _hold(user: Any, state: Any, tau: Any) -> int:
    tau[0:3] = list(state.tau_g)
    return 0


@pytest.fixture
def call(tmp_path: Path) -> Caller:
    return Caller(tmp_path)


def message() -> str:
    return ffi.string(lib.arm3r_error_message()).decode()


def by_name(name: str) -> Function:
    return next(function for function in FUNCTIONS if function.name == name)


def ids(functions: list[Function]) -> Any:
    return pytest.mark.parametrize("function", functions, ids=lambda function: function.name)


# ---- null, sizes, overlap -------------------------------------------------------------------------------------------


@ids(FALLIBLE)
def test_good_arguments_are_accepted(call: Caller, function: Function) -> None:
    assert call(function) == 0, message()


POINTERS = [(f, a) for f in FUNCTIONS if f.result == "int32_t" for a in f.arguments if a.is_pointer]


@pytest.mark.parametrize(("function", "argument"), POINTERS, ids=lambda part: part.name)
def test_null_is_refused_unless_nullable(call: Caller, function: Function, argument: Argument) -> None:
    status = call(function, **{argument.name: ffi.NULL})
    if argument.nullable:
        assert status == 0, message()
    else:
        assert status == lib.ARM3R_E_NULL
        assert argument.name in message()


def test_null_is_freed_as_nothing() -> None:
    for function in FUNCTIONS:
        if function.name.endswith("_free"):
            assert function.arguments[0].nullable
            getattr(lib, function.name)(ffi.NULL)


@ids([function for function in FALLIBLE if any(a.name == "count" and a.type == "size_t" for a in function.arguments)])
@pytest.mark.parametrize("count", [0, -1, 1, SIZE_MAX])
def test_wrong_parameter_counts_are_refused(call: Caller, function: Function, count: int) -> None:
    count = call.count + count if abs(count) == 1 else count
    assert call(function, count=count) == lib.ARM3R_E_SIZE


@ids(BATCHED)
@pytest.mark.parametrize("n", [SIZE_MAX, SIZE_MAX // 8, SIZE_MAX // 24 + 1])
def test_impossible_batches_are_refused(call: Caller, function: Function, n: int) -> None:
    assert call(function, n=n) == lib.ARM3R_E_SIZE


@ids(BATCHED)
def test_empty_batches_do_nothing(call: Caller, function: Function) -> None:
    assert call(function, n=0) == 0, message()


@ids([function for function in FALLIBLE if any(argument.name == "index" for argument in function.arguments)])
@pytest.mark.parametrize("index", [SIZE_MAX, 1 << 20])
def test_indices_beyond_the_end_are_refused(call: Caller, function: Function, index: int) -> None:
    if function.arguments[function.index("index")].type == "size_t":
        assert call(function, index=index) == lib.ARM3R_E_INDEX


def _inputs_and_outputs(function: Function) -> list[tuple[str, str]]:
    inputs = [a.name for a in function.arguments if a.type == "const double *"]
    outputs = [a.name for a in function.arguments if a.type == "double *"]
    return [(i, o) for i in inputs for o in outputs]


OVERLAPS = [(function, *pair) for function in BATCHED for pair in _inputs_and_outputs(function)]


@pytest.mark.parametrize(("function", "read", "written"), OVERLAPS, ids=lambda part: getattr(part, "name", part))
def test_overlapping_arrays_are_refused(call: Caller, function: Function, read: str, written: str) -> None:
    memory = ffi.new("double[64]", [1.2, -0.5, 0.9])
    assert call(function, **{read: memory, written: memory + 2}) == lib.ARM3R_E_OVERLAP
    assert read in message() and written in message()
    assert list(memory[0:4]) == [1.2, -0.5, 0.9, 0]


@pytest.mark.parametrize(("function", "read", "written"), OVERLAPS, ids=lambda part: getattr(part, "name", part))
@pytest.mark.parametrize("bad", [math.nan, math.inf, -2e100])
def test_nothing_is_written_where_one_number_is_bad(
    call: Caller, function: Function, read: str, written: str, bad: float
) -> None:
    states = 11
    arguments = {i: ffi.new("double[]", [1.2, -0.5, 0.9] * states) for i, _ in _inputs_and_outputs(function)}
    arguments[read][3 * states - 2] = bad
    result = ffi.new("double[]", [7.0] * 18 * states)
    others = {o: ffi.new("double[]", 18 * states) for _, o in _inputs_and_outputs(function)}
    assert call(function, **others | arguments | {written: result, "n": states}) == lib.ARM3R_E_VALUE
    assert f"{read}[10][1]" in message()
    assert list(result) == [7.0] * 18 * states


def test_neighbouring_arrays_do_not_overlap(call: Caller) -> None:
    memory = ffi.new("double[9]", [0, 1.2, -0.5, 0.9])
    tip = by_name("arm3r_arm_tip_position")
    assert call(tip, q=memory + 1, tip=memory + 4) == 0, message()


# ---- the options of a run -------------------------------------------------------------------------------------------


def _run_with(call: Caller, size: int, tail: bytes = b"", **fields: Any) -> int:
    memory = ffi.new("char[]", ffi.sizeof("arm3r_run_options") + 64)
    options = ffi.cast("arm3r_run_options *", memory)
    options.struct_size = size
    for name, value in fields.items():
        setattr(options, name, value)
    at = ffi.sizeof("arm3r_run_options")
    ffi.buffer(memory)[at : at + len(tail)] = tail
    return int(call(by_name("arm3r_scenario_run"), options=options))


OPTIONS = ffi.sizeof("arm3r_run_options")


@pytest.mark.parametrize(
    ("size", "tail", "expected"),
    [
        (OPTIONS, b"", "OK"),
        (OPTIONS - 32, b"", "OK"),  # a caller from before `trust`
        (ffi.sizeof("size_t"), b"", "OK"),
        (OPTIONS + 16, b"", "OK"),  # a later caller that asks for nothing new
        (OPTIONS + 16, b"\0" * 8 + b"\1", "E_ABI"),
        (0, b"", "E_ABI"),
        (1, b"", "E_ABI"),
        (SIZE_MAX, b"", "E_ABI"),
    ],
)
def test_size_of_the_options(call: Caller, size: int, tail: bytes, expected: str) -> None:
    assert _run_with(call, size, tail) == getattr(lib, f"ARM3R_{expected}"), message()


@pytest.mark.parametrize("place", range(3))
def test_reserved_fields_must_be_zero(call: Caller, place: int) -> None:
    reserved = [int(i == place) for i in range(3)]
    assert _run_with(call, OPTIONS, reserved=reserved) == lib.ARM3R_E_ABI
    assert "reserved" in message()


@pytest.mark.parametrize(("trust", "expected"), [(0, "OK"), (1, "OK"), (2, "E_VALUE"), (-1, "E_VALUE")])
def test_trust_is_asked_for_or_not(call: Caller, trust: int, expected: str) -> None:
    assert _run_with(call, OPTIONS, trust=trust) == getattr(lib, f"ARM3R_{expected}"), message()


@pytest.mark.parametrize("limit", [-1.0, float("nan"), -float("inf")])
def test_time_limit_must_be_a_duration(call: Caller, limit: float) -> None:
    assert _run_with(call, OPTIONS, time_limit=limit) == lib.ARM3R_E_VALUE


@pytest.mark.parametrize(
    ("field", "value", "expected"),
    [
        ("struct_size", 0, "E_ABI"),
        ("function", ffi.NULL, "E_NULL"),
        ("reentrant", 2, "E_VALUE"),
        ("reserved", [0, 0, 1, 0], "E_ABI"),
        ("reentrant", 1, "OK"),
        ("user_stride", 8, "OK"),
    ],
)
def test_the_law_of_a_batch_is_checked(call: Caller, field: str, value: Any, expected: str) -> None:
    batch = by_name("arm3r_batch_control")
    law = call.argument(batch, batch.arguments[batch.index("law")])
    setattr(law, field, value)
    assert call(batch, law=law, runs=1) == getattr(lib, f"ARM3R_{expected}"), message()


def test_the_law_of_a_batch_takes_the_place_of_no_other_controller(call: Caller) -> None:
    assert call(by_name("arm3r_batch_control"), params=call.params("none")) == lib.ARM3R_E_SCENARIO
    assert "takes the place of no other controller" in message()
    assert call(by_name("arm3r_batch_run"), params=call.params("user")) == lib.ARM3R_E_SCENARIO


def test_stop_flag_ends_the_run(call: Caller) -> None:
    stop = ffi.new("int32_t *", 1)
    options, run, outcome = call.options(), ffi.new("arm3r_run **"), ffi.new("int32_t *")
    options.stop = stop
    text = b"format: 1\nwall: {}\ntime: {stop: 1000}\n"
    scenario = ffi.new("arm3r_scenario **")
    assert lib.arm3r_scenario_create(text, len(text), b"a", 1, scenario) == 0
    assert lib.arm3r_scenario_run(scenario[0], options, run) == 0, message()
    assert lib.arm3r_run_outcome(run[0], outcome) == 0
    assert outcome[0] == lib.ARM3R_RUN_STOPPED
    lib.arm3r_run_free(run[0])
    lib.arm3r_scenario_free(scenario[0])


@pytest.mark.parametrize("outcome", [-1, 10, 2**31 - 1])
def test_unknown_outcomes_have_no_name(outcome: int) -> None:
    assert ffi.string(lib.arm3r_outcome_name(outcome)) == b""


# ---- text -----------------------------------------------------------------------------------------------------------


def _read(text: Any, size: int | None = None) -> int:
    """Read a scenario and validate it: the first failure's status."""
    out = ffi.new("arm3r_scenario **")
    size = len(text) if size is None else size
    status = lib.arm3r_scenario_create(text, size, b"text.yaml", 9, out)
    status = status or lib.arm3r_scenario_validate(out[0])
    lib.arm3r_scenario_free(out[0])
    return int(status)


def test_text_ends_where_its_length_says() -> None:
    assert _read(b"format: 1\n{{{ not yaml", 10) == 0, message()
    assert _read(b"") == lib.ARM3R_E_SCENARIO  # `format` is missing


@pytest.mark.parametrize("bad", [b"\xff", b"\xc3", b"\xed\xa0\x80", b"\xf5\x80\x80\x80", b"\xc0\xaf", b"\0"])
def test_text_that_is_not_utf8_is_refused(bad: bytes) -> None:
    text = b"format: 1\nname: a" + bad + b"b\n"
    assert _read(text) == lib.ARM3R_E_SCENARIO
    assert "text.yaml:2:" in message()


def test_text_of_enormous_length_is_not_read_to_its_end() -> None:
    assert _read(b"format: 1\n" + b"#" * (2 << 20), 1 << 40) == lib.ARM3R_E_SCENARIO


@pytest.mark.parametrize("name", ["path", "value"])
def test_values_that_are_not_utf8_are_refused(call: Caller, name: str) -> None:
    assert call(by_name("arm3r_scenario_set"), **{name: b"\xff\xfe", f"{name}_size": 2}) < 0
    json.loads(ffi.string(lib.arm3r_error_json()).decode())


# ---- errors ---------------------------------------------------------------------------------------------------------


def test_errors_belong_to_their_thread() -> None:
    assert _read(b"format: 9\n") < 0
    here, elsewhere = message(), []
    thread = threading.Thread(target=lambda: elsewhere.append((message(), _read(b"nonsense: 1\n"), message())))
    thread.start()
    thread.join()
    assert elsewhere[0][0] == "" and elsewhere[0][1] < 0 and "nonsense" in elsewhere[0][2]
    assert message() == here and here


def test_errors_outlive_a_later_success() -> None:
    assert _read(b"format: 9\n") < 0
    before = message()
    assert _read(b"format: 1\n") == 0
    assert message() == before


def test_errors_as_json() -> None:
    assert _read(b"format: 1\nwal: {}\n") == lib.ARM3R_E_SCENARIO
    error = json.loads(ffi.string(lib.arm3r_error_json()))
    assert error["status"] == lib.ARM3R_E_SCENARIO
    (problem,) = error["problems"]
    assert set(problem) == {"code", "message", "file", "line", "column", "path", "got", "allowed", "hint"}
    assert (problem["file"], problem["line"], problem["column"], problem["path"]) == ("text.yaml", 2, 1, "wal")
    assert "wall" in problem["hint"]


# ---- versions, symbols, header --------------------------------------------------------------------------------------


def _nm(*arguments: object) -> set[str]:
    text = subprocess.run(["nm", *map(str, arguments)], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1].split("@")[0] for line in text.splitlines() if " " in line.strip()}


def test_library_of_another_version_is_refused(tmp_path: Path, python: Any) -> None:
    source, other = tmp_path / "other.c", tmp_path / "libother.so"
    source.write_text("int arm3r_abi_version(void) { return 77; }\n")
    subprocess.run(["cc", "-shared", "-fPIC", source, "-o", other], check=True)
    done = python("import arm3r_cpp; arm3r_cpp.Arm", LD_PRELOAD=str(other))
    assert done.returncode == 1
    assert "IncompatibleError" in done.stderr
    assert "version 77" in done.stderr and f"version {lib.ARM3R_ABI}" in done.stderr


def test_exported_symbols_are_the_declared_functions(package: Path) -> None:
    exported = _nm("-D", "--defined-only", package / "lib" / "libarm3r.so") - {"ARM3R_1"}
    assert exported == {function.name for function in FUNCTIONS}


@pytest.mark.parametrize(("compiler", "standard", "language"), [("cc", "c99", "c"), ("c++", "c++17", "c++")])
def test_header_compiles_alone(tmp_path: Path, package: Path, compiler: str, standard: str, language: str) -> None:
    source = tmp_path / "use"
    source.write_text('#include "arm3r/arm3r.h"\nint main(void) { return arm3r_abi_version() - ARM3R_ABI; }\n')
    flags = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only", f"-I{package / 'include'}"]
    subprocess.run([compiler, f"-std={standard}", *flags, "-x", language, source], check=True)


@pytest.fixture(scope="session")
def core(root: Path) -> Path:
    """The numeric core as a static library, from the build tree of the C++ tests."""
    archive = root / "build" / "ctest" / "libarm3r_core.a"
    if not archive.is_file():
        pytest.skip(f"{archive} is not built: make test")
    return archive


def _libm() -> set[str]:
    """What only libm has: frexp, ldexp, copysign and the like are in libc too, and exact."""
    path = {name: subprocess.check_output(["cc", f"-print-file-name={name}"], text=True).strip() for name in LIBRARIES}
    libm, libc = (_nm("-D", "--defined-only", path[name]) for name in LIBRARIES)
    return libm - libc


LIBRARIES = ("libm.so.6", "libc.so.6")


def test_no_libm_function_but_sqrt_in_the_core(core: Path) -> None:
    assert _nm("-u", core) & _libm() <= {"sqrt"}


def test_no_libm_function_but_sqrt_in_the_library(package: Path) -> None:
    assert _nm("-D", "-u", package / "lib" / "libarm3r.so") & _libm() <= {"sqrt"}


def test_the_core_knows_neither_yaml_nor_files(core: Path, root: Path) -> None:
    forbidden = re.compile(
        r"YAML|basic_[io]?fstream|basic_filebuf|filesystem|^f?open(at|64)?$|^fopen64$|^printf$|^exit$"
    )
    undefined = _nm("-u", core)
    assert not [symbol for symbol in undefined if forbidden.search(symbol)]
    # of the system it asks for memory and for the number of CPUs
    headers = [root / "cpp/src/platform" / name for name in ("memory.hpp", "threads.hpp")]
    allowed = {name for header in headers for name in re.findall(r"(\w+)\(", header.read_text())}
    of_the_system = [symbol for symbol in undefined if "arm3r8platform" in symbol]
    assert of_the_system
    assert all(any(f"{len(name)}{name}E" in symbol for name in allowed) for symbol in of_the_system), of_the_system
