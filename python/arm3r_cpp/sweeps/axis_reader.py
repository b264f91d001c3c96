"""The axes of a sweep's file: one key each, and the rule for its values."""

from __future__ import annotations

import math
from typing import Any

from .._messages import did_you_mean
from ..core.batch import same_places
from ..core.params import param_key, places
from .axes import DISTRIBUTIONS, SPACES, SweepAxis
from .yaml_reader import Node, Reader, below, flow

MAX_RUNS = 10**10
RULES = {
    "values": "These: numbers, words, true and false, or lists where the key takes several numbers.",
    **dict.fromkeys(SPACES, "[a, b, n]: n numbers from a to b, by equal steps (linspace) or equal ratios (geomspace)."),
    **dict.fromkeys(DISTRIBUTIONS, "[a, b], or [mean, deviation] of normal: drawn from this distribution."),
}


def read_axes(reader: Reader, top: dict[str, Node], mode: str) -> tuple[SweepAxis, ...]:
    if "axes" not in top:
        top["axes"] = {"line": 1, "column": 1, "list": []}
        reader.problem(top["axes"], "sweep.missing_key", "axes", "there are none", hint=_EXAMPLE_AXIS)
        return ()
    axes: list[SweepAxis] = []
    for i, node in enumerate(reader.list(top["axes"], "axes")):
        axis = _read_axis(reader, node, f"axes[{i}]", mode)
        if axis is None:
            continue
        for other in axes:
            if twice := same_places(axis.key, other.key):
                both = f"{twice[0]} varies twice, as {other.key} and as {axis.key}"
                reader.problem(node, "sweep.duplicate", f"axes[{i}].key", both, hint="take one of the two out")
        axes.append(axis)
    return tuple(axes)


_EXAMPLE_AXIS = "such as {key: wall.contact.stiffness, geomspace: [1.0e+2, 1.0e+6, 40]}"


def _read_axis(reader: Reader, node: Node, path: str, mode: str) -> SweepAxis | None:
    given = reader.map(node, path, ("key", *RULES))
    rules = [rule for rule in RULES if rule in given]
    if "map" in node and ("key" not in given or len(rules) != 1):
        wrong = "`key` is missing" if "key" not in given else f"one rule is needed, got {', '.join(rules) or 'none'}"
        reader.problem(node, "sweep.axis", path, wrong, allowed=f"one of {', '.join(RULES)}", hint=_EXAMPLE_AXIS)
    if "key" not in given or len(rules) != 1:
        return None
    key, rule = reader.word(given["key"], below(path, "key")), rules[0]
    if key is None:
        return None
    if key not in places():
        reader.problem(given["key"], "sweep.unknown_key", below(path, "key"), "no number or choice has this key",
                       got=key, hint=did_you_mean(key, places()))  # fmt: skip
        return None
    if rule in DISTRIBUTIONS and mode in ("grid", "list"):
        reader.problem(given[rule], "sweep.mode", below(path, rule), f"mode {mode} does not draw numbers",
                       hint="use linspace, geomspace or values, or mode random or latin_hypercube")  # fmt: skip
        return None
    read = _read_values if rule == "values" else _read_rule
    items = read(reader, given[rule], below(path, rule), key, rule)
    return SweepAxis(key, rule, tuple(items), param_key(places()[key][0]).unit) if items else None


def _read_values(reader: Reader, node: Node, path: str, key: str, _: str) -> list[Any]:
    kind = param_key(places()[key][0]).kind
    items = [_read_value(reader, item, f"{path}[{i}]", kind) for i, item in enumerate(reader.list(node, path))]
    shapes = {(type(item), len(item) if isinstance(item, list) else 0) for item in items}
    if len(shapes) > 1 and None not in items:
        reader.problem(
            node, "sweep.shape", path, "all values of an axis are alike: numbers, words, or lists of a length"
        )
    return [] if len(shapes) != 1 or None in items else items


def _read_value(reader: Reader, node: Node, path: str, kind: str) -> Any:
    if "list" in node:
        numbers = [_read_value(reader, item, f"{path}[{i}]", kind) for i, item in enumerate(reader.list(node, path))]
        return None if None in numbers else numbers
    if kind == "flag" and node.get("text") in ("true", "false") and not node["quoted"]:
        return node["text"] == "true"
    if kind in ("choice", "flag", "file", "arm_file") or node.get("text") == "infinite":
        return reader.word(node, path)
    return reader.number(node, path, degrees=kind == "angle")


def _read_rule(reader: Reader, node: Node, path: str, key: str, rule: str) -> list[float]:
    kind = param_key(places()[key][0]).kind
    nodes = reader.list(node, path)
    if len(nodes) != (3 if rule in SPACES else 2):
        if nodes:
            form = "[mean, deviation]" if rule == "normal" else f"[from, to{', count' if rule in SPACES else ''}]"
            reader.problem(node, "sweep.shape", path, f"{form} is needed", got=f"a list of {len(nodes)}")
        return []
    a, b = (reader.number(item, f"{path}[{i}]", degrees=kind == "angle") for i, item in enumerate(nodes[:2]))
    counts = [reader.whole(item, f"{path}[2]", 1, MAX_RUNS) for item in nodes[2:]]
    if a is None or b is None or None in counts:
        return []
    good, allowed = {
        "linspace": (math.isfinite(b - a), "two finite numbers"),
        "geomspace": (a > 0 and b > 0 and 0 < b / a < math.inf, "two numbers above 0"),
        "uniform": (a < b and math.isfinite(b - a), "two numbers, the smaller one first"),
        "log_uniform": (0 < a < b and b / a < math.inf, "two numbers above 0, the smaller one first"),
        "normal": (b > 0 and math.isfinite(abs(a) + 10 * b), "a mean, and a deviation above 0"),
    }[rule]
    if not good:
        reader.problem(node, "sweep.range", path, "out of range", got=flow(node), allowed=allowed)
    return [a, b, *(count for count in counts if count)] if good else []
