"""Why runs of a batch are refused before they begin: each reason once, with how often it holds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol

from ..errors import Arm3rError

SHOWN = 5
"""Reasons that are listed; the others are counted."""


class Validated(Protocol):
    """A scenario."""

    def validate(self) -> None: ...


class Refusal(NamedTuple):
    """A reason for which runs are invalid."""

    reason: str
    """The error's code and the key that it is about: what the runs have in common."""
    runs: int
    """how many"""
    message: str
    """Of the first of these runs."""


def refusals_of(scenarios: Iterable[Validated]) -> list[Refusal]:
    """The reasons of scenarios that are not valid, the most frequent first. Each counts once, by its first error."""
    found = []
    for scenario in scenarios:
        try:
            scenario.validate()
        except Arm3rError as error:
            first = error.problems[0] if error.problems else {"code": error.code, "path": ""}
            line = str(error).splitlines()[0]
            found.append(Refusal(f"{first['code']} {first['path']}", 1, line[line.find("error[") :]))
    return merged([found])


def merged(parts: Iterable[Sequence[Refusal]]) -> list[Refusal]:
    """The reasons of several lists, the most frequent first."""
    all_of_them: dict[str, Refusal] = {}
    for part in parts:
        for one in part:
            before = all_of_them.get(one.reason)
            all_of_them[one.reason] = before._replace(runs=before.runs + one.runs) if before else one
    return sorted(all_of_them.values(), key=lambda one: -one.runs)


def lines_of(refusals: Sequence[Refusal], invalid: int) -> list[str]:
    """A line a reason with how often it holds, and one for those that are not listed.

    invalid: how many runs are.
    """
    lines = [f"{one.runs} invalid, such as: {one.message}" for one in refusals[:SHOWN]]
    if rest := refusals[SHOWN:]:
        lines.append(f"{sum(one.runs for one in rest)} invalid for {len(rest)} other reasons")
    if unasked := invalid - sum(one.runs for one in refusals):
        lines.append(f"{unasked} more invalid, which were not asked why")
    return lines
