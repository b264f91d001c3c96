"""Reading a sweep's file: nodes of the library's strict YAML reader, and problems with their places."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

from .._messages import describe, did_you_mean, place
from ..errors import ScenarioError

Node = Mapping[str, Any]
MAX_PROBLEMS = 20


class Reader:
    """Takes values out of nodes. It lists every problem that it finds, and raises them together at the end."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.problems: list[dict[str, Any]] = []

    def problem(self, node: Node, code: str, path: str, message: str, **more: str) -> None:
        """Note a problem at a node, or at its key where it has one; `more`: got, allowed, hint."""
        line, column = position(node)
        self.problems.append(
            {"code": code, "message": message, "file": self.file, "line": line, "column": column, "path": path}
            | {"got": "", "allowed": "", "hint": ""}
            | more
        )

    def place(self, node: Node) -> str:
        """file:line:column of a node."""
        return place(self.file, *position(node))

    def finish(self) -> None:
        """Raise ScenarioError when there were problems."""
        if self.problems:
            shown = self.problems[:MAX_PROBLEMS]
            raise ScenarioError("\n".join(map(describe, shown)), code=shown[0]["code"], problems=shown)

    def map(self, node: Node, path: str, allowed: Iterable[str] | None = None) -> dict[str, Node]:
        """The nodes of a map by key; `allowed`: all the keys that there are."""
        if "map" not in node:
            self.problem(node, "sweep.type", path, "must be a map", got=shape_of(node))
            return {}
        for child in node["map"]:
            if allowed is not None and child["key"] not in allowed:
                self.problem(child, "sweep.unknown_key", below(path, child["key"]), "there is no such key",
                             allowed=", ".join(allowed), hint=did_you_mean(child["key"], allowed))  # fmt: skip
        return {child["key"]: child for child in node["map"] if allowed is None or child["key"] in allowed}

    def list(self, node: Node, path: str) -> list[Node]:
        if "list" not in node:
            self.problem(node, "sweep.type", path, "must be a list", got=shape_of(node))
        elif not node["list"]:
            self.problem(node, "sweep.empty", path, "must not be empty")
        return list(node.get("list", []))

    def number(self, node: Node, path: str, *, degrees: bool = False) -> float | None:
        if "number" not in node:
            message = str(node.get("fault", "must be a number"))
            self.problem(node, "number.syntax", path, message, got=shape_of(node))
        elif node["degrees"] and not degrees:
            self.problem(node, "number.syntax", path, "only angles can be given in degrees", got=shape_of(node))
        else:
            return float(node["number"])
        return None

    def whole(self, node: Node, path: str, low: int, high: int) -> int | None:
        number = self.number(node, path)
        if number is None:
            return None
        if not number.is_integer() or not low <= number <= high:
            allowed = f"a whole number from {low} to {high}"
            self.problem(node, "sweep.range", path, "out of range", got=shape_of(node), allowed=allowed)
            return None
        return int(number)

    def word(self, node: Node, path: str, words: Iterable[str] | None = None) -> str | None:
        """Text; `words`: all that there are."""
        text = node.get("text")
        if text is None:
            self.problem(node, "sweep.type", path, "must be text", got=shape_of(node))
        elif words is not None and text not in words:
            self.problem(node, "sweep.unknown_word", path, "must be one of the words", got=text,
                         allowed=", ".join(words), hint=did_you_mean(text, words))  # fmt: skip
            return None
        return text


def position(node: Node) -> tuple[int, int]:
    """The line and the column of a node's key, or of the node itself where it has none."""
    return node.get("key_line", node["line"]), node.get("key_column", node["column"])


def below(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def shape_of(node: Node) -> str:
    if "text" in node:
        return json.dumps(node["text"], ensure_ascii=False) if node["quoted"] else str(node["text"])
    return f"a list of {len(node['list'])}" if "list" in node else "a map" if "map" in node else "nothing"


def flow(node: Node) -> str:
    """A node as YAML in flow style."""
    if "map" in node:
        return "{" + ", ".join(f"{quoted(child['key'])}: {flow(child)}" for child in node["map"]) + "}"
    if "list" in node:
        return "[" + ", ".join(map(flow, node["list"])) + "]"
    if "text" not in node:
        return "null"
    text = str(node["text"])
    return quoted(text) if node["quoted"] or set(text) & set(",[]{}:#\"'") else text


def quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
