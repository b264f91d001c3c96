"""ARM3R_MINUTES=15: the tests run in an order that ARM3R_SEED decides, and none begins after so many minutes."""

from __future__ import annotations

import os
import random
import time

import pytest
from random_scenarios import sample_seed

VARIABLE = "ARM3R_MINUTES"
_UNTIL = "ARM3R_UNTIL"  # for the processes of pytest-xdist


def pytest_configure() -> None:
    if minutes := os.environ.get(VARIABLE):
        os.environ.setdefault(_UNTIL, str(time.monotonic() + 60 * float(minutes)))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    if _UNTIL in os.environ:
        random.Random(sample_seed()).shuffle(items)


def pytest_runtest_setup() -> None:
    if time.monotonic() > float(os.environ.get(_UNTIL, "inf")):
        pytest.skip(f"{VARIABLE}={os.environ[VARIABLE]} are over")
