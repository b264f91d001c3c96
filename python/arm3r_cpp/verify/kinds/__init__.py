"""The kinds of formula that are judged, a class each.

A kind says what its formulas take and return, what is due (asked of an arm), on what of an arm that depends, and by
which names of functions and columns of a log it is found. Everything else in `verify` is the same for all kinds: a new
one is a class in a module here, an entry in `KINDS` and in `_BY_NAME`, and a function in `functions`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from .controller import Controller
from .coriolis import Coriolis
from .forward import Forward
from .gravity import Gravity
from .inverse import Inverse
from .jacobian import Jacobian
from .jacobian_dot import JacobianDot
from .kind import ANGULAR, SPATIAL, Kind, Rows
from .kinematics import Kinematics
from .mass import Mass

KINDS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        Jacobian(),
        JacobianDot(),
        Gravity(),
        Kinematics(),
        Mass(),
        Coriolis(),
        Inverse(),
        Forward(),
        Controller(),
    )
}
"""By their names, in the order in which they are listed, and looked for in a log."""

__all__ = ["ANGULAR", "KINDS", "SPATIAL", "Kind", "Rows", "kind_of_name", "kinds_of_outputs"]

_BY_NAME = (
    "jacobian_dot", "controller", "forward", "inverse", "coriolis", "gravity", "jacobian", "mass", "kinematics",
)  # fmt: skip
"""The order in which names are compared with kinds: the Jacobian of a tip is no tip."""


def kind_of_name(name: str) -> str | None:
    """The kind of formula that a name tells: of a function, a method, a file or an output."""
    lower = name.rpartition(".")[2].lower()
    if "forward_kin" in lower or "fkin" in lower:
        return "kinematics"
    if re.search(r"dot_?q", lower):  # the product of a rate and the rates
        return None
    if "kinetic" in lower or re.search(r"inverse_?kin|inv_?kin|(?<![a-z])ik(?![a-z])", lower):  # of an energy, of poses
        return None
    for kind in (KINDS[one] for one in _BY_NAME):
        for word in kind.called:
            if (len(word) > 2 and word in f"_{lower}") or word in (lower.split("_")[0], lower.split("_")[-1]):
                return kind.name
    return next((kind.name for kind in KINDS.values() if lower in kind.letters), None)


def kinds_of_outputs(outputs: Sequence[str]) -> list[str | None]:
    """The kinds that the names of a function's outputs tell: H of [H, C, g] is a mass matrix, that of [h, g] is not."""
    kinds = [kind_of_name(name) for name in outputs]
    if "mass" in kinds:
        return kinds
    for place, name in enumerate(outputs):
        others = kinds[:place] + kinds[place + 1 :]
        is_beside = "coriolis" in others or (kinds[place] is None and "gravity" in others)
        if is_beside and name.lower() in KINDS["mass"].letters_beside:
            return [*kinds[:place], "mass", *kinds[place + 1 :]]
    return kinds
