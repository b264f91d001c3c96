"""Values as YAML."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

_PLAIN = re.compile(r"[\w+.-][\w+. -]*(?<! )", re.ASCII)  # text that means the same without quotes in YAML's flow style


def flow(value: Any, path: str) -> str:
    """A value in YAML's flow style."""
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return value if _PLAIN.fullmatch(value) else json.dumps(value, ensure_ascii=False)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(flow(item, f'{path}[{i}]') for i, item in enumerate(value))}]"
    if isinstance(value, Mapping):
        return (
            "{"
            + ", ".join(f"{flow(str(key), path)}: {flow(item, f'{path}.{key}')}" for key, item in value.items())
            + "}"
        )
    raise TypeError(f"{path}: a number, text, flag, list, array or map is needed, got {type(value).__name__}")
