"""A scenario as somebody would write it: without what holds by default, angles in degrees."""

from __future__ import annotations

import math
import re

from ..core.scenario import Scenario
from ..errors import Arm3rError

_ENTRY = re.compile(r"( *)(\w+):(?: (.*))?")
_NUMBER = re.compile(r"-?\d[\d.e+-]*")
_NUMBERS = re.compile(rf"{_NUMBER.pattern}|\[{_NUMBER.pattern}(, {_NUMBER.pattern})*\]")
_LONG = 12  # letters of a number that somebody would not write
_DIGITS = 10  # of an angle in degrees that somebody would


def plain_text(text: str) -> str:
    """The scenario of a run in fewer and shorter words, which is read as the same numbers, to the last bit.

    Args:
        text: the whole scenario, with all defaults, as the summary of a run holds it.

    Raises:
        ScenarioError: the text is no valid scenario.
    """
    settings, mark, checks = text.partition("\nchecks:")
    plain = _Plain(Scenario(text))
    lines = [line for line in map(plain.line, settings.splitlines()) if line is not None]
    followers = [*lines[1:], ""]
    closed = [
        f"{line} {{}}" if line.endswith(":") and _depth(after) <= _depth(line) else line
        for line, after in zip(lines, followers, strict=True)
    ]
    return "\n".join(closed) + (mark + checks if mark else "\n")


class _Plain:
    """Takes the lines of a whole scenario one after the other, and leaves out of it what changes nothing."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario.quiet()
        self.whole = scenario.to_yaml()
        self.places: list[tuple[int, str]] = []  # indentation and key of the sections that a line is in
        self.left_out = ""

    def line(self, line: str) -> str | None:
        """The line, perhaps with its angles in degrees; None where the scenario is the same without it."""
        entry = _ENTRY.fullmatch(line)
        if not entry:
            return line
        indent, key, value = entry.groups()
        self.places = [place for place in self.places if place[0] < len(indent)] + [(len(indent), key)]
        path = ".".join(key for _, key in self.places)
        if self.left_out and path.startswith(self.left_out):
            return None
        self.left_out = f"{path}." if self._is_same_with(path, "null") else ""
        if self.left_out:
            return None
        degrees = in_degrees(value or "")
        return f"{indent}{key}: {degrees}" if degrees and self._is_same_with(path, degrees) else line

    def _is_same_with(self, path: str, value: str) -> bool:
        """Whether a value (YAML) at a path changes nothing; then it is taken."""
        changed = self.scenario.copy()
        try:
            changed.edit(path, value, "the page")
            same = changed.to_yaml() == self.whole
        except Arm3rError:
            return False
        if same:
            self.scenario = changed
        return same


def in_degrees(value: str) -> str:
    """Long numbers in rad as the angles in degrees that they probably are; "" where they are none."""
    numbers = _NUMBER.findall(value) if _NUMBERS.fullmatch(value) else []
    degrees = [f"{math.degrees(float(number)):.{_DIGITS}g}" for number in numbers]
    is_short = all(len(angle) < _LONG and "e" not in angle for angle in degrees)
    if not is_short or all(len(number) < _LONG for number in numbers):
        return ""
    angles = iter(degrees)
    return _NUMBER.sub(lambda _: f"{next(angles)} deg", value)


def _depth(line: str) -> int:
    return len(line) - len(line.lstrip())
