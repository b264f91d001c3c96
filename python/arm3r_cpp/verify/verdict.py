"""The verdict on a user's formula: the findings, as text, as data, and as a table."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from .._messages import as_json
from .finding import Finding, Judgement
from .words import report, table

__all__ = ["Finding", "Verdict"]


@dataclass
class Verdict(Judgement):
    """The verdict on a formula; it is true where the formula is right."""

    def __bool__(self) -> bool:
        return self.ok

    @property
    def complexity(self) -> tuple[int, int, int]:
        """Of verdicts on a formula that may be meant in several ways, the simplest explanation is the likeliest."""
        words = (" reads ", " has ", " explain it")
        without_cause = sum(one.old is None and any(word in one.cause for word in words) for one in self.findings)
        edits = {(one.line, one.column, one.new) for one in self.findings}
        return len(self.unexplained), without_cause, len(edits)

    def to_dict(self) -> dict[str, Any]:
        """What `arm3r verify --json` prints."""
        whole = asdict(self)
        del whole["text"]
        return whole

    def to_json(self) -> str:
        return as_json(self.to_dict())

    def __str__(self) -> str:
        return report(self)

    def _repr_html_(self) -> str:
        return table(self)
