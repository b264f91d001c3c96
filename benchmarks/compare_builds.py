"""Compare the results of two builds of arm3r, bit by bit.

    python benchmarks/compare_builds.py OLD_PYTHON NEW_PYTHON

OLD_PYTHON and NEW_PYTHON are interpreters in whose environments one build each is installed. Each of them runs every
scenario of this checkout by every method that the scenario allows, runs some batches, and prints the reference pages.
The program lists what differs: columns, summary numbers, events, batch columns, pages and exported symbols. It compares
what both builds have, and names what only one of them has. Exit code 0: nothing differs, 1: something does.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

SCENARIOS = Path(__file__).parents[1] / "scenarios"
METHODS = ("dopri5", "rodas4", "auto", "rk4", "taylor")
BATCHES = {
    "moving_wall.yaml": {"wall.contact.stiffness": [100, 1e3, 1e4, 1e5], "wall.acts_on_arm": True},
    "force_control/b9a_hybrid.yaml": {"wall.contact.stiffness": [500, 1e3, 2e3]},
    "force_control/sampled_with_sensors.yaml": {"wall.contact.stiffness": [500, 1e3, 2e3]},
}
PAGES = ("schema", "columns", "template", "--help")

# Not a result: wall-clock time, the build's own name, and a hash over all columns, which new columns change.
NOT_RESULTS = {"elapsed_s", "version", "hash"}


def digest(data: bytes) -> str:
    """A short hash of `data`."""
    return hashlib.sha256(data).hexdigest()[:16]


def run_results(scenario: Any, prefix: str) -> dict[str, str]:
    """Hashes of every column, and the text of every summary number, of one run."""
    import arm3r_cpp as arm3r

    try:
        run = scenario.run()
    except arm3r.Arm3rError as error:
        run = error.run  # the rows so far and the outcome are results too
        if run is None:
            return {f"{prefix} refused": type(error).__name__}
    results = {f"{prefix} column {name}": digest(run[name].tobytes()) for name in run.columns}
    for name, value in run.summary.items():
        if isinstance(value, dict) and name not in NOT_RESULTS:
            results |= {f"{prefix} summary {name}.{key}": repr(number) for key, number in value.items()}
        elif name not in NOT_RESULTS:
            results[f"{prefix} summary {name}"] = repr(value)
    return results


def collect() -> dict[str, str]:
    """All results of the build that this interpreter has."""
    import arm3r_cpp as arm3r

    package = Path(arm3r.__file__).parent
    results: dict[str, str] = {}
    for path in sorted(SCENARIOS.rglob("*.yaml")):
        if path.parent.name == "sweeps":
            continue
        name = str(path.relative_to(SCENARIOS))
        results |= run_results(arm3r.Scenario.load(path), f"{name} as it is:")
        for method in METHODS:
            scenario = arm3r.Scenario.load(path)
            scenario["solver"] = {"method": method}
            scenario["checks"] = []
            results |= run_results(scenario, f"{name} by {method}:")
    for name, values in BATCHES.items():
        for method in METHODS:
            scenario = arm3r.Scenario.load(SCENARIOS / name)
            scenario["solver"] = {"method": method}
            scenario["checks"] = []
            try:
                batch = scenario.batch(values)
            except arm3r.Arm3rError as error:
                results[f"batch {name} by {method}: refused"] = type(error).__name__
                continue
            for column in batch.names:
                results[f"batch {name} by {method}: {column}"] = digest(batch[column].tobytes())
    for page in PAGES:
        text = subprocess.run([package / "bin" / "arm3r", page], capture_output=True, check=True).stdout
        results[f"page {page}"] = digest(text)
    symbols = subprocess.run(
        ["nm", "-D", "--defined-only", package / "lib" / "libarm3r.so"], capture_output=True, text=True, check=True
    ).stdout
    results |= {f"symbol {line.split()[-1]}": "" for line in symbols.splitlines()}
    return results


def main(old: str, new: str) -> int:
    """Compare two builds and print what differs."""
    builds = [subprocess.Popen([python, __file__, "--collect"], stdout=subprocess.PIPE) for python in (old, new)]
    before, after = (json.loads(build.communicate()[0]) for build in builds)
    differing = [name for name in before if name in after and before[name] != after[name]]
    for name in differing:
        print(f"differs: {name}")
    for label, only in (
        ("only the old build has", before.keys() - after.keys()),
        ("only the new build has", after.keys() - before.keys()),
    ):
        counts = Counter(name.partition(": ")[2] or name for name in only)
        for name, count in sorted(counts.items()):
            print(f"{label}: {name} ({count} times)")
    print(f"{len(before.keys() & after.keys())} results compared, {len(differing)} differ")
    return 1 if differing else 0


if __name__ == "__main__":
    if sys.argv[1:] == ["--collect"]:
        json.dump(collect(), sys.stdout)
    elif len(sys.argv) == 3:
        sys.exit(main(*sys.argv[1:]))
    else:
        sys.exit(__doc__)
