"""The processors of this computer."""

from __future__ import annotations

import os
import sys


def usable_cpus() -> int:
    """How many this process may use."""
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
