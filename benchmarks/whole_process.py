"""Runs with 10 001 rows as whole processes, ours beside MuJoCo's Python API: the lecture's moving wall, and a digital
hybrid controller at 1 kHz that presses on it. CSV out.

python benchmarks/whole_process.py [RUNS]
"""

from __future__ import annotations

import json
import os
import statistics
import sys
import tempfile
import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import arm3r_cpp
from table import Table

HERE = Path(__file__).parent
SCENARIOS = HERE.parent / "scenarios"
EXECUTABLE = next(path for place in arm3r_cpp.__path__ if (path := Path(place, "bin", "arm3r")).is_file())
PEER_RUNS = 5


def timed(*command: str | Path) -> tuple[float, str]:
    """Wall time in ms from starting a process to its end, and what it printed."""
    words = [str(word) for word in command]
    with tempfile.TemporaryFile("w+") as out:
        begun = time.perf_counter()
        process = os.posix_spawn(words[0], words, os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, out.fileno(), 1)])
        _, status = os.waitpid(process, 0)
        ended = time.perf_counter()
        if status:
            raise SystemExit(f"{' '.join(words)}: ended with wait status {status}")
        out.seek(0)
        return (ended - begun) * 1e3, out.read()


def remove_results(out: Path) -> None:
    for path in (out, out.with_suffix(".json")):
        path.unlink(missing_ok=True)


def ours(runs: int, scenario: Path, out: Path) -> dict[str, list[float]]:
    parts: dict[str, list[float]] = {name: [] for name in ("whole", "over", "without -o", "start", "loop")}
    for _ in range(runs):
        _, summary = timed(EXECUTABLE, "run", scenario, "--json")
        remove_results(out)
        for part in ("whole", "over"):
            parts[part].append(timed(EXECUTABLE, "run", scenario, "-o", out)[0])
        parts["without -o"].append(timed(EXECUTABLE, "run", scenario)[0])
        parts["start"].append(timed(EXECUTABLE, "--version")[0])
        parts["loop"].append(json.loads(summary)["elapsed_s"] * 1e3)
    return parts | {"text": [statistics.median(parts["whole"]) - statistics.median(parts["without -o"])]}


def mujocos(program: str, out: Path) -> dict[str, list[float]]:
    parts: dict[str, list[float]] = {name: [] for name in ("whole", "import", "loop", "text")}
    for _ in range(PEER_RUNS):
        remove_results(out)
        whole, printed = timed(sys.executable, HERE / program, out)
        parts["whole"].append(whole)
        for name, seconds in json.loads(printed).items():
            parts[name].append(seconds * 1e3)
    return parts


def compare(table: Table, job: str, build: str, scenario: Path, program: str, runs: int) -> None:
    with tempfile.TemporaryDirectory() as place:
        out = Path(place, "out.csv")
        mine = ours(runs, scenario, out)
        table.row(job, "arm3r", build, "ms", mine["whole"])
        try:
            peer = "MuJoCo " + version("mujoco") + ", Python API"
        except PackageNotFoundError:
            table.row(job, "MuJoCo", "not installed", "ms", [])
            theirs = {}
        else:
            theirs = mujocos(program, out)
            table.row(job, "MuJoCo", peer, "ms", theirs["whole"])
    for name, (our_part, their_part) in {
        "start": ("start", "import"),
        "loop": ("loop", "loop"),
        "CSV (ours: and JSON)": ("text", "text"),
        "without -o": ("without -o", ""),
        "over an earlier result": ("over", ""),
    }.items():
        table.row(f"{job}: {name}", "arm3r", build, "ms", mine[our_part])
        if their_part in theirs:
            table.row(f"{job}: {name}", "MuJoCo", peer, "ms", theirs[their_part])


def main() -> None:
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    table = Table()
    build = timed(EXECUTABLE, "--version")[1].replace("\n", ", ").rstrip(", ")
    for job, scenario, program in (
        ("moving wall", SCENARIOS / "moving_wall.yaml", "mujoco_moving_wall.py"),
        ("hybrid controller at 1 kHz on it", HERE / "hybrid_wall.yaml", "mujoco_hybrid_wall.py"),
    ):
        compare(table, f"{job}, 10 001 rows, whole process", build, scenario, program, runs)


main()
