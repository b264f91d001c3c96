"""The tutorial prints what it says, step by step."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path


def test_every_step_prints_what_it_says(root: Path, tmp_path: Path) -> None:
    (tmp_path / "scenarios").symlink_to(root / "scenarios")
    blocks = re.findall(r"```python\n(.*?)```", (root / "docs/tutorial.md").read_text(), re.S)
    assert len(blocks) >= 9
    code = "\n".join(blocks)
    promised = re.findall(r"print\(.*\)  # (.*)", code)
    assert len(promised) == code.count("print(")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == promised
