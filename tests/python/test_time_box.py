"""With ARM3R_MINUTES no test begins after so many minutes, and the seed decides which ones begin before."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

TESTS = """
import pytest
@pytest.mark.parametrize("i", range(30))
def test_of_a_list(i): print(f"case {i}.")
"""


def test_the_time_is_kept_and_the_order_is_drawn(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text("from time_box import *")
    (tmp_path / "test_all.py").write_text(TESTS)

    def call(minutes: str, seed: str) -> str:
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
        environment |= {"ARM3R_MINUTES": minutes, "ARM3R_SEED": seed}
        command = [sys.executable, "-m", "pytest", "-rP", "-p", "no:cacheprovider"]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True).stdout

    assert "30 skipped" in call("0", "1")
    orders = [re.findall(r"case \d+\.", call("60", seed)) for seed in ("1", "2", "1")]
    assert orders[0] == orders[2] != orders[1] and sorted(orders[0]) == sorted(orders[1])
