"""The JSON Schema of sweep files: an editor offers by it keys, rules, columns, and the names of what can vary."""

from __future__ import annotations

import json
from typing import Any

from .. import _native
from ..core.params import param_key, places
from .axes import MODES, SPACES
from .axis_reader import RULES
from .definition import DEFAULT_SEED, DEFAULT_SHARD, FORMAT, KEYS, MAX_SHARD
from .shard import STATISTICS, Statistic

Schema = dict[str, Any]

_WHOLE: Schema = {"type": "integer", "minimum": 1}
_NUMBER: Schema = {"anyOf": [{"type": "number"}, {"type": "string", "pattern": "^[-+.0-9e]+ +deg$"}]}


def sweep_schema() -> str:
    """The schema as text: draft 7, which every editor knows."""
    drawn = {"properties": {"mode": {"enum": [mode for mode in MODES if mode not in ("grid", "list")]}}}
    schema: Schema = {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "arm3r sweep",
        "type": "object",
        "required": ["format", "scenario", "axes"],
        "additionalProperties": False,
        "properties": {key: {"description": text, **_value(key)} for key, text in KEYS.items()},
        "if": {**drawn, "required": ["mode"]},
        "then": {"required": ["runs"]},
        "else": {"properties": {"runs": False}},
    }
    return json.dumps(schema, indent=1) + "\n"


def _value(key: str) -> Schema:
    metrics = [name for name in _native.summary_columns() if name != "outcome"]
    columns = [line.split()[0] for line in _native.string(_native.lib.arm3r_columns_text()).splitlines()]
    statistic = {"column": {"enum": columns}, "of": {"enum": list(STATISTICS)}}
    values: dict[str, Schema] = {
        "format": {"const": FORMAT},
        "scenario": {"type": ["string", "object"]},
        "set": {"type": "object", "propertyNames": {"enum": _paths()}},
        "axes": {"type": "array", "minItems": 1, "items": _axis()},
        "mode": {"enum": list(MODES), "default": MODES[0]},
        "runs": _WHOLE,
        "seed": {"type": "integer", "minimum": 0, "default": DEFAULT_SEED},
        "metrics": {"type": "array", "minItems": 1, "uniqueItems": True, "items": {"enum": ["outcome", *metrics]}},
        "statistics": {"type": "array", "minItems": 1, "items": _map(statistic, list(Statistic._fields))},
        "shard": {**_WHOLE, "maximum": MAX_SHARD, "default": DEFAULT_SHARD},
    }
    return values[key]


def _map(properties: Schema, required: list[str]) -> Schema:
    return {"type": "object", "additionalProperties": False, "properties": properties, "required": required}


def _axis() -> Schema:
    varied = [name for name, indices in places().items() if param_key(indices[0]).kind not in ("section", "column")]
    properties = {
        "key": {"enum": varied},
        **{rule: {"description": text, **_rule(rule)} for rule, text in RULES.items()},
    }
    return {**_map(properties, ["key"]), "oneOf": [{"required": [rule]} for rule in RULES]}


def _rule(rule: str) -> Schema:
    if rule == "values":
        return {"type": "array", "minItems": 1}
    count = 3 if rule in SPACES else 2
    items = [_NUMBER, _NUMBER, _WHOLE][:count]
    return {"type": "array", "items": items, "minItems": count, "maxItems": count}


def _paths() -> list[str]:
    """What `set` can name: every key, every number of a key, and every section."""
    sections = {name.rsplit(".", depth)[0] for name in places() for depth in range(1, name.count(".") + 1)}
    return list(dict.fromkeys(["name", "checks", *sorted(sections), *places()]))
