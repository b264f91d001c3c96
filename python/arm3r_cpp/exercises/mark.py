"""What a submission is marked with."""

from __future__ import annotations

from dataclasses import dataclass

from .._messages import shown

RIGHT, WRONG, UNCLEAR, MISSING = "right", "wrong", "unclear", "missing"
WORDS = (RIGHT, WRONG, UNCLEAR, MISSING)
_ROOM = 10.0
_LONGEST = 200  # characters of a reason


@dataclass(frozen=True)
class Mark:
    """A mark: one of `WORDS`, and why."""

    word: str
    found: str = ""
    """What is right and what is not, in one line."""
    cause: str = ""
    """The mistake, where it is one that is known."""
    message: str = ""
    """What a program or the library says; it may differ from machine to machine, and is in no table."""

    @property
    def reason(self) -> str:
        """One line for the teacher."""
        return ": ".join(part for part in (self.found, self.cause) if part)


def word_of(error: float, threshold: float) -> str:
    """Right where an error is less than a tenth of its threshold, wrong above ten times, and unclear between."""
    if error <= threshold / _ROOM:
        return RIGHT
    return UNCLEAR if error < threshold * _ROOM else WRONG


def worst(words: list[str]) -> str:
    """One word for several: wrong if one is wrong, else unclear if one is unclear."""
    return next((word for word in (WRONG, UNCLEAR) if word in words), RIGHT)


def one_line(text: str, longest: int = _LONGEST) -> str:
    """The text as `shown` shows it, and not too long."""
    line = shown(text.strip())
    return line if len(line) <= longest else f"{line[: longest - 3]}..."


def two_digits(number: float) -> str:
    """The number with two digits: 230, 81, 0.0098."""
    return f"{float(f'{number:.2g}'):g}"
