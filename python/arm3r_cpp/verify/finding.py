"""What is found about a user's formula, as data."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass
class Finding:
    """A wrong entry of a formula, or with `entry` None a mistake that concerns the formula as a whole."""

    entry: list[int] | None
    """[row, column] from 1; [row] of a vector."""
    cause: str
    """One sentence."""
    reads: str | None = None
    """What the entry reads, as a sum of terms in the parameters' names."""
    due: str | None = None
    """What it should read."""
    line: int | None = None
    column: int | None = None
    """Where `old` stands in the source, from 1, in characters."""
    old: str | None = None
    new: str | None = None
    """What is to stand in the place of `old`."""
    seen_by: dict[str, bool] = field(default_factory=dict)
    """For each test whether it sees this entry's error."""
    unseen_because: dict[str, str] = field(default_factory=dict)
    """For each test that does not see it the special value that hides it."""


@dataclass
class Judgement:
    """What is found about a formula."""

    ok: bool
    kind: str
    convention: str
    residual: float
    """The largest difference from what is right, in the entry's unit."""
    is_angular: bool = field(default=False, kw_only=True)
    """Whether that entry is in an angular row of a Jacobian: it has no unit."""
    findings: list[Finding] = field(default_factory=list)
    alternatives: list[str] = field(default_factory=list)
    """Explanations that are equally true."""
    unexplained: list[list[int]] = field(default_factory=list)
    """The wrong entries for which neither terms nor an edit were found."""
    coverage: dict[str, Any] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    not_judged: dict[str, str] = field(default_factory=dict)
    """The kinds of other outputs of the function, by their names."""
    file: str = ""
    found: list[str] = field(default_factory=list)
    """What was found rather than asked: the order of arguments, the unit of angles."""
    shape: list[int] = field(default_factory=list)
    text: str | None = field(default=None, repr=False)
    """The source."""
