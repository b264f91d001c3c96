"""What tests would have seen: which entries and joints they excite."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def seen_by_tests(verdict: Any, case: Any, tests: Mapping[str, Any]) -> None:
    """Fill in for each finding whether a test sees it."""
