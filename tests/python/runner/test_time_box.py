"""With ARM3R_MINUTES no test begins after so many minutes, and the seed decides which ones begin before."""

from __future__ import annotations

import re
from pathlib import Path

from inner_pytest import run_pytest

TESTS = """
import pytest
@pytest.mark.parametrize("i", range(30))
def test_of_a_list(i): print(f"case {i}.")
"""


def test_the_time_is_kept_and_the_order_is_drawn(tmp_path: Path) -> None:
    def call(minutes: str, seed: str) -> str:
        box = {"ARM3R_MINUTES": minutes, "ARM3R_SEED": seed}
        return run_pytest(tmp_path, "from time_box import *", TESTS, "-rP", **box)[1]

    assert "30 skipped" in call("0", "1")
    orders = [re.findall(r"case \d+\.", call("60", seed)) for seed in ("1", "2", "1")]
    assert orders[0] == orders[2] != orders[1] and sorted(orders[0]) == sorted(orders[1])
