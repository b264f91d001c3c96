"""Reads a user's formula back: is it right, and if not, which term is wrong, in which line?

In comes a formula of an arm (a function, a file, a log), and the arm it is meant for. Out comes a `Verdict`. `judge`
goes the way from one to the other: `formula` evaluates what the user wrote, by the room `user_functions`, and what is
`told` of its names; `kinds` says what its kind takes and returns, `truth` knows what is right, `comparison` holds both
beside each other, `meaning` finds how it is meant, `explain` finds causes, `failure` is for what returns no numbers,
`doubts` for what stays open, `coverage` says what other tests would have seen, and `words` says it all in sentences.
Nothing here steps physics, and files of the user run in a process of their own.

>>> verdict = arm3r.verify.jacobian(my_jacobian)
>>> verdict.ok, verdict.findings
"""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .functions import *  # noqa: F403


def __getattr__(name: str) -> Any:
    # The process that runs a user's file imports this package, too, and needs nothing of this.
    functions = import_module(f"{__name__}.functions")
    if name not in functions.__all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; it has {', '.join(functions.__all__)}")
    return getattr(functions, name)


def __dir__() -> list[str]:
    return sorted(import_module(f"{__name__}.functions").__all__)
