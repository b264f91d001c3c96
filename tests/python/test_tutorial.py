"""The tutorial and the page about Python print what they say, step by step."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.parametrize(("page", "count"), [("tutorial.md", 9), ("python.md", 6)])
def test_every_step_prints_what_it_says(root: Path, tmp_path: Path, page: str, count: int) -> None:
    if page == "python.md":
        pytest.importorskip("pandas")
        pytest.importorskip("xarray")
    (tmp_path / "scenarios").symlink_to(root / "scenarios")
    blocks = re.findall(r"```python\n(.*?)```", (root / "docs" / page).read_text(), re.S)
    assert len(blocks) >= count
    code = "\n".join(blocks)
    promised = re.findall(r"print\(.*\)  # (.*)", code)
    assert len(promised) == code.count("print(")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == promised
