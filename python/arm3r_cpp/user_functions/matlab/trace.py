"""What each statement of a function wrote at some states: after an edit, those that it leaves alone write the same."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from ..expressions import Node
from .syntax import Assignment, For, Function, Kept, Statement, Switch

Execute = Callable[[list[Statement], dict[str, Any]], None]


@dataclass
class Effect:
    """Of a statement of a function's body; a field counts as its structure."""

    reads: frozenset[str]
    """Variables and functions whose values it may depend on."""
    writes: frozenset[str]
    written: dict[str, Any]
    removed: list[str]


@dataclass
class Trace:
    """One evaluation of a function without an edit, for those with one at the same states."""

    function: Function
    effects: list[Effect] = field(default_factory=list)

    def record(self, variables: dict[str, Any], execute: Execute) -> None:
        for statement in self.function.body:
            before = dict(variables)
            execute([statement], variables)
            self.effects.append(_effect(statement, before, variables))

    def replay(self, edited: Statement, others: Iterable[str], variables: dict[str, Any], execute: Execute) -> None:
        """Execute the statements whose effects are other ones with an edit; the others get theirs.

        Args:
            others: the names of the functions that change, where the edited statement stands in none of the body.
        """
        place = next((number for number, one in enumerate(self.function.body) if edited in one.walk()), None)
        changed = {self.function.name, *(others if place is None else ())}
        for number, statement in enumerate(self.function.body):
            effect = self.effects[number] if number < len(self.effects) else None
            if effect is None or number == place or effect.reads & changed:
                execute([statement], variables)
                changed |= _names_written(statement)
                continue
            for name in effect.removed:
                variables.pop(name, None)
            variables.update(effect.written)
            changed -= effect.writes


def can_be_traced(functions: Iterable[Function]) -> bool:
    """Whether a call depends on its inputs alone: no variables stay from call to call, or are shared with another."""
    return not any(
        one.is_nested or any(isinstance(inner, Kept) for top in one.body for inner in top.walk()) for one in functions
    )


def _effect(statement: Statement, before: dict[str, Any], after: dict[str, Any]) -> Effect:
    writes = _names_written(statement)
    written = {name: value for name, value in after.items() if _whole(name) in writes}
    is_replaced = isinstance(statement, Assignment) and not any(target.way for target in statement.targets)
    reads = {_whole(node.word) for node in _nodes(statement)}
    if not is_replaced or set(written) != writes:  # a part of what is there is written, or perhaps nothing
        reads |= writes
    return Effect(frozenset(reads), writes, written, [name for name in before if name not in after])


def _names_written(statement: Statement) -> frozenset[str]:
    targets = (target for one in statement.walk() if isinstance(one, Assignment) for target in one.targets)
    turning = (one.name for one in statement.walk() if isinstance(one, For))
    return frozenset(_whole(name) for name in (*(target.name for target in targets), *turning) if name)


def _nodes(statement: Statement) -> Iterator[Node]:
    for one in statement.walk():
        if one.value:
            yield from one.value.walk()
        ways = (step for target in one.targets for step in target.way) if isinstance(one, Assignment) else ()
        for node in (*ways, *(one.labels if isinstance(one, Switch) else ())):
            yield from node.walk()


def _whole(name: str) -> str:
    """The structure of a field."""
    return name.partition(".")[0]
