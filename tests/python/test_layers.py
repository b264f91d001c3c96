"""The parts of the C++ sources know only what lies below them."""

from __future__ import annotations

import os
import re
import subprocess
import sysconfig
from pathlib import Path

import pytest

SETUP = (
    "setup setup_controller setup_instants setup_rules setup_rules_controller setup_rules_sampling setup_sampling "
    "setup_setpoint setup_slips setup_slips_controller"
)

RUNS = (
    "simulation ledger diagnosis row_log recorder runs adaptive_run stepwise marching_run march march_members "
    "march_with_memory fixed_march taylor_march score"
)

# From the bottom up. The parts of one line do not know each other; the files of one part do.
LAYERS = [
    ["arm3r", "primitives", "row_memory", "presets", "fp_environment"],
    ["elementary", "numbers text"],
    ["real", "error", "rough_root", "random"],
    ["dual", "expr", "pack", "schema suggest", "columns", "findings", "callback"],
    ["eigen_traits", "lane_access", "apart"],
    ["course", "vectors", "integrators", "polynomial", "restitution", "small_lu", "spline"],
    ["arm", "wall", "at", "linearization", "estimator"],
    ["kinematics", "recursion", "contact", "rodas"],
    ["dynamics"],
    ["setpoint", "loop_limits"],
    ["controllers"],
    ["task_space", "digital", "observer", "user_law", "loop_limits"],
    ["motion_laws impedance_laws force_loop force_laws adaptive_reference admittance energy_tank virtual_wall"],
    ["energy_reserve"],
    ["laws"],
    ["plant", "compiled_laws"],
    ["lanes", "taylor_recipes", "step_limits"],
    ["laws_of_lanes laws_of_numbers laws_of_rows laws_of_slopes"],
    ["control_loop", SETUP, "model_batch", "derive_taylor", "taylor"],
    ["sample sample_into sample_together", "law_state"],
    ["validate", "contact_step", "size_cap", "stepper"],
    ["events"],
    [RUNS],
    ["summary"],
    ["batch crew lineup lineup_memory lineup_rk4 lineup_taylor"],
    ["yaml_events", "input", "output"],
    ["paths", "yaml_json"],
    ["checks results csv", "meant_key"],
    ["scenario scenario_set scenario_text"],
    ["reference"],
    ["c_api c_api_batch c_api_error c_api_law c_api_numbers c_api_text"],
    ["cli"],
]
HEIGHT = {stem: height for height, layer in enumerate(LAYERS) for part in layer for stem in part.split()}
PART = {stem: part for layer in LAYERS for part in layer for stem in part.split()}

# What only these parts may include.
RESERVED = {
    r"yaml-cpp/.*": {"yaml_events"},
    r"fstream|filesystem|fcntl\.h|unistd\.h|sys/.*|cstdio|stdio\.h": {
        "input",
        "output",
        "cli",
        "row_memory",
        "derive_taylor",
    },
    r"iostream": {"cli"},
}


def _sources(root: Path) -> list[Path]:
    return [path for path in sorted((root / "cpp").rglob("*")) if path.suffix in (".h", ".hpp", ".cpp")]


def _includes(path: Path) -> list[tuple[str, str]]:
    return re.findall(r'^#include ([<"])(.*)[>"]', path.read_text(), re.M)


def _stem(name: str) -> str:
    stem = Path(name).stem
    return "cli" if stem.startswith("cli") else stem


def test_every_file_has_a_place_and_every_place_a_file(root: Path) -> None:
    assert {_stem(path.name) for path in _sources(root)} == HEIGHT.keys()


def test_no_include_points_up(root: Path) -> None:
    upward = [
        f"{path.name} includes {name}"
        for path in _sources(root)
        for kind, name in _includes(path)
        if kind == '"'
        and PART[_stem(name)] != PART[_stem(path.name)]
        and HEIGHT[_stem(name)] >= HEIGHT[_stem(path.name)]
    ]
    assert upward == []


def test_files_and_yaml_stay_where_they_belong(root: Path) -> None:
    misplaced = [
        f"{path.name} includes {name}"
        for path in _sources(root)
        for kind, name in _includes(path)
        for reserved, parts in RESERVED.items()
        if kind == "<" and re.fullmatch(reserved, name) and _stem(path.name) not in parts
    ]
    assert misplaced == []


def test_the_executable_knows_only_the_c_interface(root: Path) -> None:
    for path in _sources(root):
        if _stem(path.name) == "cli":
            own = [name for kind, name in _includes(path) if kind == '"' and not name.startswith("cli")]
            assert own == ["arm3r/arm3r.h"] or own == [], path.name


KIND = r"(?:struct|class|enum class|enum)"
TYPE = re.compile(rf"(?:template ?<.*> ?)?{KIND} (?:\w+\(\d+\) )?(\w+)(?: final)?(?: ?: ?[^;]*)? ?\{{")


def _types(path: Path) -> list[str]:
    """The types that a file defines for others, with their namespaces: not those in an unnamed one or in a type."""
    found: list[str] = []
    around: list[str | None] = []  # a namespace's name, or None of any other pair of braces
    text = re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])'", "", path.read_text(), flags=re.S)
    start = 0
    for brace in re.finditer(r"[{};]", text):
        head = " ".join(text[start : brace.end()].split())
        start = brace.end()
        if brace[0] == "}":
            around.pop()
        elif brace[0] == "{":
            space = re.search(r"\bnamespace ?([\w:]*) ?\{$", head)
            kind = TYPE.search(head)
            if kind and all(around):
                found.append("::".join([*filter(None, around), kind[1]]))
            around.append(space[1] if space else None)
    return found


def test_one_name_is_one_type(root: Path) -> None:
    """Two types of one name in one namespace are undefined behaviour in every program that has both."""
    places: dict[str, set[str]] = {}
    for path in _sources(root):
        for name in _types(path):
            places.setdefault(name, set()).add(path.name)
    assert places.keys() >= {"arm3r::Plant", "arm3r::TapeNode", "arm3r::Node", "arm3r::Rows", "arm3r::Controls"}
    assert {name: files for name, files in places.items() if len(files) > 1} == {}


@pytest.mark.gate
def test_one_name_is_one_type_to_the_linker(root: Path, tmp_path: Path, scripts: Path) -> None:
    """All of the library, its programs and its tests as one program: the linker compares the types of one name."""
    environment = os.environ | {"PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}
    flags = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O0", "-DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON"]
    flags += ["-DARM3R_LANES=2", "-DARM3R_PCH=OFF", "-DARM3R_TESTS=ON", "-DARM3R_PYTHON=OFF"]
    flags += [f"-DCMAKE_PREFIX_PATH={sysconfig.get_path('purelib')}"]
    make = ["cmake", "--build", str(tmp_path), "--target", "all", "arm3r_tests", "--parallel", "4"]
    for command in (["cmake", "-S", str(root), "-B", str(tmp_path), *flags], make):
        subprocess.run(command, check=True, env=environment, capture_output=True)
    objects = [str(path) for path in tmp_path.rglob("*.o")]
    assert len(objects) > 90
    link = ["g++", "-O0", "-flto=4", "-shared", "-Wodr", "-Werror=odr", "-Wl,--allow-multiple-definition"]
    done = subprocess.run([*link, *objects, "-o", str(tmp_path / "all.so")], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
