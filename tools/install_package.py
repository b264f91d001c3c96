"""Install the package into this Python, and say meanwhile how far the compiler is.

    python tools/install_package.py [FOLDER]

pip itself is silent while it builds, which takes minutes the first time. Its output is shown where it fails."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator

CPU_MINUTES = 5  # to compile everything, measured on one core of an AMD EPYC with g++ 12
STEP = re.compile(r"\s*\[(\d+)/(\d+)\] (Building \w+ object )?(.*)")
SHORTEST = 10  # steps of a build of which it is said how long it takes


def main(folder: str) -> int:
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--no-compile"]
    pip += ["--no-build-isolation", "-v", folder]
    # Batches for this processor's registers alone: a fifth less to compile. Not by pip's option -C, which is of 2023.
    environment = {"SKBUILD_CMAKE_DEFINE": "ARM3R_LANES=native", **os.environ}
    output: list[str] = []
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "bufsize": 1}
    with subprocess.Popen(pip, env=environment, **pipes) as build:
        assert build.stdout is not None
        for line in reported(build.stdout, output):
            print(line, flush=True)
    if build.returncode:
        print("".join(output), file=sys.stderr)
    return build.returncode


def reported(lines: Iterable[str], output: list[str]) -> Iterator[str]:
    """Of what the build prints, which is kept in `output`, the lines that say how far it is."""
    for line in lines:
        output.append(line)
        if not (step := STEP.match(line)):
            continue
        done, steps, _, what = step.groups()
        if done == "1" and int(steps) >= SHORTEST:
            yield duration()
        yield f"[{done}/{steps}] {what.strip()}"


def duration() -> str:
    jobs = int(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", os.cpu_count() or 1))
    minutes = -(-CPU_MINUTES // jobs)
    return f"Compiling arm3r: about {minutes} min the first time, {jobs} jobs at once; later only what has changed."


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else "."))
