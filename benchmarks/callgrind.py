"""Instructions counted by valgrind: the same on a busy machine as on a quiet one.

valgrind offers no AVX-512: a build that takes the widest registers at run time takes those of AVX2 here.
"""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

MARK = "getppid"  # os.getppid() in a Python program ends one count and begins the next


def printed(command: Sequence[str | Path]) -> str:
    """What a program prints that sees valgrind's processor."""
    valgrind = ["valgrind", "--tool=none", "--quiet"]
    return subprocess.run([*valgrind, *command], check=True, stdout=subprocess.PIPE, text=True).stdout


def counts(command: Sequence[str | Path]) -> list[int]:
    """Instructions of a whole process, in as many parts as its marks divide it into."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "counts"
        options = [f"--callgrind-out-file={out}", f"--dump-before={MARK}", "--combine-dumps=yes"]
        environment = {**os.environ, "PYTHONHASHSEED": "0"}
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", *options, *command], env=environment, capture_output=True, text=True
        )
        if done.returncode != 0:
            raise SystemExit(f"{' '.join(map(str, command))}: failed under valgrind\n{done.stderr}")
        return [int(count) for count in re.findall(r"^totals: (\d+)", out.read_text(), re.MULTILINE)]
