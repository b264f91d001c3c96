"""The C++ sources stand in rooms, one folder for each concern, and know only the rooms below their own."""

from __future__ import annotations

import json
import os
import platform
import re
import shutil
import subprocess
import sysconfig
from collections import Counter
from pathlib import Path

import pytest
from conftest import CALLS

# From the bottom up: a header includes headers of its own room and of rooms that stand before it.
HEADERS = [*(f"include/arm3r/{room}" for room in ("numbers", "model", "ode", "control", "sensing")), "include/arm3r"]
MOST_FILES = 16  # with a name of their own: X.hpp and X.cpp are one

# What only these files may include.
RESERVED = {
    r"yaml-cpp/.*": {"yaml_tree"},
    r"fstream|filesystem|fcntl\.h|unistd\.h|sys/.*|cstdio|stdio\.h": {
        "posix",
        "windows",
        "launcher",
        "launcher_windows",
        "derive_taylor",
    },
    r"windows\.h|csignal|cxxabi\.h|sched\.h|io\.h|process\.h|mach-o/.*": {
        "posix",
        "windows",
        "launcher",
        "launcher_windows",
        "threads",
        "terminal",
    },
}


def _sources(root: Path) -> list[Path]:
    return [path for path in sorted((root / "cpp").rglob("*")) if path.suffix in (".c", ".h", ".hpp", ".cpp")]


def _includes(path: Path) -> list[tuple[str, str]]:
    return re.findall(r'^#include ([<"])(.*)[>"]', path.read_text(), re.M)


def _room(root: Path, path: Path) -> str:
    return path.parent.relative_to(root / "cpp").as_posix()


def _room_of_include(name: str) -> str:
    folder = Path(name).parent.as_posix()
    return f"include/{folder}" if name.startswith("arm3r/") else f"src/{folder}"


@pytest.fixture(scope="module")
def seen(root: Path) -> dict[str, set[str]]:
    """Of each room of the program, the rooms whose headers its compiler finds: what CMakeLists.txt says after SEES."""
    seen: dict[str, set[str]] = {}
    for room, rooms in re.findall(r"^ *arm3r_room\((\w+)(?: SEES((?: [a-z]+)+))?", _cmake(root), re.M):
        seen[room] = {room}.union(*(seen[below] for below in rooms.split()))
    return seen


def _cmake(root: Path) -> str:
    return "\n".join((root / name).read_text() for name in ("CMakeLists.txt", "cmake/wasm.cmake"))


def test_every_room_has_a_target_and_a_page(root: Path, seen: dict[str, set[str]]) -> None:
    found = {_room(root, path) for path in _sources(root)}
    assert found == {*HEADERS, *(f"src/{room}" for room in seen)}
    titles = {room: (root / "cpp" / room / "README.md").read_text().split("\n")[0] for room in found}
    assert not {room: title for room, title in titles.items() if not title.startswith("# ")}


def test_no_include_points_up(root: Path, seen: dict[str, set[str]]) -> None:
    """Where a source is compiled the compiler refuses it; here headers are read too."""
    generated = {"taylor_kernels.hpp"}
    upward = []
    for path in _sources(root):
        room = _room(root, path)
        if room in HEADERS:
            may = HEADERS[: HEADERS.index(room) + 1]
        else:
            may = [*HEADERS, *(f"src/{below}" for below in seen[path.parent.name])]
        names = [name for kind, name in _includes(path) if kind == '"' and name not in generated]
        upward += [f"{room}/{path.name} includes {name}" for name in names if _room_of_include(name) not in may]
    assert upward == []


def test_a_compiler_finds_the_headers_of_the_rooms_that_a_room_sees(root: Path, seen: dict[str, set[str]]) -> None:
    commands = root / "build/ctest/compile_commands.json"
    if not commands.is_file():
        pytest.skip(f"{commands} is not there: make test")
    found: dict[str, set[str]] = {}
    for step in json.loads(commands.read_text()):
        if room := re.search(r"/arm3r_(\w+)\.dir/", step["output"]):
            found.setdefault(room[1], set()).update(re.findall(r"-I\S*/rooms/(\w+)", step["command"]))
    compiled = seen.keys() - {"wasm"}
    assert {room: found[room] for room in compiled} == {room: seen[room] for room in compiled}


def test_no_packs_go_through_files_whose_lambdas_may_be_called(root: Path) -> None:
    """A function that is called takes no wide registers (widths.hpp), so that such a file must need none."""
    commands = root / "build/ctest/compile_commands.json"
    if not commands.is_file() or not (disassembler := shutil.which("objdump")) or platform.machine() != "x86_64":
        pytest.skip("needs `make test` on a PC, and objdump")
    objects = [
        Path(step["directory"]) / step["output"]
        for step in json.loads(commands.read_text())
        if "-DARM3R_INLINE_LAMBDA=" in step["command"] and "/cpp/src/" in step["file"]
    ]
    assert objects
    for path in objects:
        text = subprocess.run([disassembler, "-d", "--no-show-raw-insn", path], capture_output=True, check=True).stdout
        found = {width for width in ("xmm", "ymm", "zmm") if f"%{width}".encode() in text}
        assert found == {"xmm"}, path.name


def test_no_room_is_too_large(root: Path) -> None:
    names = {(_room(root, path), path.stem) for path in _sources(root)}
    assert {room: count for room, count in Counter(room for room, _ in names).items() if count > MOST_FILES} == {}


def _declared_functions(path: Path) -> set[str]:
    """The names of the functions that a header declares for other files and does not define itself."""
    text = re.sub(r"//[^\n]*|#(?:\\\n|[^\n])*", "", path.read_text())
    found: set[str] = set()
    around: list[bool] = []  # of each open pair of braces: whether it is a namespace
    start = 0
    for end in re.finditer(r"[{};]", text):
        head = " ".join(text[start : end.start()].split())
        start = end.end()
        if end[0] == "{":
            around.append(re.search(r"\bnamespace\b", head) is not None)
        elif end[0] == "}":
            around.pop()
        elif all(around) and not re.match(r"(template|inline|using|static|struct|class|enum|constexpr|ARM3R)\b", head):
            name = re.match(r"(?:\[\[\w+\]\] )?[\w:<>,&* ]+?[ &*](\w+)\(", head)
            found |= {name[1]} if name else set()
    return found


def test_a_function_is_defined_in_the_file_that_declares_it(root: Path) -> None:
    """Declared in X.hpp, a function is defined in X.cpp, or in X_something.cpp beside it."""
    elsewhere = []
    for header in (root / "cpp/src").rglob("*.hpp"):
        if header.parent.name == "platform":
            continue
        own = [path.read_text() for path in header.parent.glob("*.cpp") if path.stem.startswith(header.stem)]
        for name in sorted(_declared_functions(header)):
            definition = re.compile(
                rf"^(?!\s|return|using)[^\n;=]*\b{name}\([^;{{}}]*\)(?: const)?(?: noexcept)? ?\{{", re.M
            )
            if not any(definition.search(text) for text in own):
                elsewhere.append(f"{_room(root, header)}/{header.name} declares {name}")
    assert elsewhere == []


def test_every_platform_defines_every_function(root: Path) -> None:
    room = root / "cpp/src/platform"
    declared = set[str]().union(*(_declared_functions(header) for header in room.glob("*.hpp")))
    assert len(declared) > 20
    platforms = {path.name: path.read_text() for path in room.glob("*.cpp")}
    assert platforms.keys() == {"posix.cpp", "windows.cpp", "wasm.cpp"}
    library = "".join(
        path.read_text() for path in _sources(root) if _room(root, path) not in ("src/platform", "src/cli")
    )
    of_the_library = {name for name in declared if f"platform::{name}(" in library}  # wasm.cpp: there is no executable
    assert len(of_the_library) > 10
    missing = [
        f"{file} has no {name}"
        for file, text in platforms.items()
        for name in sorted(of_the_library if file == "wasm.cpp" else declared)
        if not re.search(rf"^\w[^\n;=]*\b{name}\(", text, re.M)
    ]
    assert missing == []


def test_no_other_file_asks_which_system_it_is_compiled_for(root: Path) -> None:
    asking = {
        path.relative_to(root / "cpp").as_posix()
        for path in _sources(root)
        if re.search(r"__linux__|_WIN32|__APPLE__|__EMSCRIPTEN__", path.read_text())
    }
    assert {name for name in asking if not name.startswith("src/platform/")} <= {"src/cli/launcher.c"}


def _function_lengths(path: Path) -> list[tuple[int, str]]:
    """The lines of each function, and its first line: formatted code ends a function where its indentation returns."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    found = []
    for start, line in enumerate(lines):
        opens = re.search(r"\)(?: const)?(?: noexcept)?(?: override)? \{$", line)
        if not opens or re.match(r" *(if|for|while|switch|else|\}|return|const auto|.*\[)", line):
            continue
        body = len(lines[start + 1]) - len(lines[start + 1].lstrip())
        end = next(n for n in range(start + 1, len(lines)) if re.match(rf" {{{body - 4}}}\}}", lines[n]))
        found.append((end - start + 1, f"{path.name}:{start + 1}: {line.strip()}"))
    return found


def test_functions_are_taken_in_at_a_glance(root: Path) -> None:
    long = [
        (length, place)
        for path in _sources(root)
        for length, place in _function_lengths(path)
        if length > (40 if _room(root, path) in ("src/run", "src/lanes", "src/record", "include/arm3r/ode") else 60)
    ]
    assert long == []


def test_the_tour_names_files_and_names_that_there_are(root: Path) -> None:
    tour = (root / "cpp/src/README.md").read_text()
    files = {path.name for path in _sources(root)} | {"README.md", "test_layers.py", "model.md"}
    named = {Path(name).name for name in re.findall(r"`([\w/.]+\.(?:hpp|cpp|py|md))`", tour)}
    assert named - files == set()
    ways = re.findall(r"^- \*(.*?)(?=^- \*|^$)", tour, flags=re.M | re.S)
    assert len(ways) == 4
    package = (root / "python/arm3r_cpp").rglob("*.py")
    code = "\n".join(path.read_text() for path in [*_sources(root), *package])
    for way in ways:
        names = [name for name in re.findall(r"`(\w+)`", way) if not re.fullmatch(r"tau\d", name)]
        assert 0 < len(names) <= 7
        assert [name for name in names if not re.search(rf"\b{name}\b", code)] == []


def test_files_and_yaml_stay_where_they_belong(root: Path) -> None:
    misplaced = [
        f"{path.name} includes {name}"
        for path in _sources(root)
        for kind, name in _includes(path)
        for reserved, files in RESERVED.items()
        if kind == "<" and re.fullmatch(reserved, name) and path.stem not in files
    ]
    assert misplaced == []


def _read_by(root: Path, path: Path, seen: set[str]) -> set[str]:
    """The headers of ours that a file includes, and those that they include."""
    for kind, name in _includes(path):
        header = next(
            (place / name for place in (root / "cpp/include", root / "cpp/src") if (place / name).exists()), None
        )
        if kind == '"' and header and name not in seen:
            seen.add(name)
            _read_by(root, header, seen)
    return seen


def test_a_change_of_a_law_compiles_the_files_of_the_laws_alone(root: Path) -> None:
    readers = {
        path.name
        for path in _sources(root)
        if path.suffix == ".cpp" and "arm3r/control/control_laws.hpp" in _read_by(root, path, set())
    }
    assert readers == {f"laws_of_{numbers}.cpp" for numbers in ("lanes", "numbers", "rows", "slopes")}
    laws = {name for _, name in _includes(root / "cpp/include/arm3r/control/control_laws.hpp")}
    for path in _sources(root):
        if path.suffix == ".cpp" and path.name not in readers:
            assert laws & _read_by(root, path, set()) == set(), path.name


def test_the_executable_knows_only_the_c_interface(root: Path) -> None:
    for path in (root / "cpp/src/cli").iterdir():
        own = (
            [name for kind, name in _includes(path) if kind == '"' and not name.startswith(("cli/", "platform/"))]
            if path.suffix != ".md"
            else []
        )
        assert own in ([], ["arm3r/arm3r.hpp"]), path.name
    around = [name for kind, name in _includes(root / "cpp/include/arm3r/arm3r.hpp") if kind == '"']
    assert around == ["arm3r/arm3r.h"]


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
            places.setdefault(name, set()).add(path.as_posix())
    assert places.keys() >= {
        "arm3r::Plant",
        "arm3r::TapeNode",
        "arm3r::Node",
        "arm3r::StateRows",
        "arm3r::ControllerType",
    }
    assert {name: files for name, files in places.items() if len(files) > 1} == {}


@pytest.mark.gate
def test_one_name_is_one_type_to_the_linker(root: Path, tmp_path: Path, scripts: Path) -> None:
    """All of the library, its programs and its tests as one program: the linker compares the types of one name."""
    environment = os.environ | {"PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}
    flags = ["-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_FLAGS_RELEASE={CALLS}"]
    flags += ["-DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON"]
    flags += ["-DARM3R_LANES=2", "-DARM3R_UNITY=OFF", "-DARM3R_TESTS=ON", "-DARM3R_PYTHON=OFF"]
    flags += [f"-DCMAKE_PREFIX_PATH={sysconfig.get_path('purelib')}"]
    ninja = ["ninja", "-C", str(tmp_path)]

    def run(*command: str) -> str:
        return subprocess.run(command, check=True, env=environment, capture_output=True, text=True).stdout

    run("cmake", "-S", str(root), "-B", str(tmp_path), "-G", "Ninja", *flags)
    objects = re.findall(r"^(\S+\.o): CXX_COMPILER", run(*ninja, "-t", "targets", "all"), re.M)
    run(*ninja, "-j4", *objects)
    assert len(objects) > 90
    link = ["g++", "-O0", "-flto=4", "-Wodr", "-Werror=odr"]
    link += ["-Wl,--allow-multiple-definition", "-Wl,--unresolved-symbols=ignore-all"]
    done = subprocess.run([*link, *objects, "-o", "all"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
