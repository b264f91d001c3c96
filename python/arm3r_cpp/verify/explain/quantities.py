"""Formulas that are right for an arm with other masses, lengths, centres of mass, inertias or another g."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from ..._native import Floats
from ..kinds import Kind
from .frames import Mistake

States = dict[str, Floats]
Truth = Callable[[States, dict[str, Floats]], Floats]
"""What is right at the joint vectors of all rows, with other values of quantities: (rows, ...)."""


def steiner_words(links: Sequence[int], *, twice: bool) -> str:
    """What is said of a formula with the parallel axes of one link twice, or without them; or of several links."""
    one = f"the inertia of link {links[0]} is about the " if len(links) == 1 else "the inertias are about the "
    if twice:
        return f"the parallel-axis term m l^2 is counted twice: {one}{'joint' if len(links) == 1 else 'joints'} already"
    return f"the parallel-axis term m l^2 is missing: {one}{'centre' if len(links) == 1 else 'centres'} of mass"


def centre_words(links: Sequence[int], place: str) -> str:
    """What is said of a formula with the centres of mass at the links' ends, or in their middles."""
    if len(links) == 1:
        return f"the centre of mass of link {links[0]} is taken at the link's {place}"
    numbers = f"{', '.join(map(str, links[:-1]))} and {links[-1]}"
    return f"the centres of mass of links {numbers} are taken at the links' {place}s"


_EXCHANGED = {
    "length": ("a2", "a3"),
    "mass": ("m2", "m3"),
    "com": ("the centre of mass of link 2", "that of link 3"),
    "inertia": ("the inertia of link 2", "that of link 3"),
}
_LINKS = ((2, 3), (2,), (3,))


def of_other_quantities(kind: Kind, truth: Truth, states: States, given: dict[str, Floats]) -> Iterator[Mistake]:
    """
    Args:
        given: the values of each quantity in all rows.
    """

    def changed(**new: Floats) -> Callable[[], Floats]:
        return lambda: truth(states, new)

    yield from _exchanged(changed, given)
    if {f"{what}{link}" for what in ("length", "com", "mass", "inertia") for link in (2, 3)} <= set(given):
        yield from _of_links(kind, changed, given)
    if "gravity" in given:
        g = given["gravity"]
        yield "g is missing", changed(gravity=np.ones_like(g)), 1
        yield "g is multiplied in twice", changed(gravity=g**2), 1
        yield "gravity is left out", changed(gravity=0 * g), 1
        yield "gravity has the wrong direction", changed(gravity=-g), 1


Changed = Callable[..., Callable[[], Floats]]


def _exchanged(changed: Changed, given: dict[str, Floats]) -> Iterator[Mistake]:
    for what, (one, other) in _EXCHANGED.items():
        first, second = f"{what}2", f"{what}3"
        if first in given and second in given and not np.allclose(given[first], given[second]):
            yield f"{one} and {other} are exchanged", changed(**{first: given[second], second: given[first]}), 1
            yield f"{one} stands in the place of {other}", changed(**{second: given[first]}), 1
            yield f"{other} stands in the place of {one}", changed(**{first: given[second]}), 1


def _of_links(kind: Kind, changed: Changed, given: dict[str, Floats]) -> Iterator[Mistake]:
    """Points and inertias of one link, or of both."""
    if not kind.needs_masses:
        yield "the point is the centre of mass of link 3; it should be the tip", changed(length3=given["com3"]), 1
        return
    for links in _LINKS:
        for place, factor in (("end", 1.0), ("middle", 0.5)):
            moved = {f"com{link}": factor * given[f"length{link}"] for link in links}
            yield centre_words(links, place), changed(**moved), 1
        if kind.depends_on_inertia:
            doubled = {f"inertia{link}": given[f"inertia{link}"] + given[f"mass{link}"] * given[f"com{link}"] ** 2
                       for link in links}  # fmt: skip
            yield steiner_words(links, twice=True), changed(**doubled), 1
            if kind.is_linear:
                yield steiner_words(links, twice=False), partial(_mirrored, changed(), changed(**doubled)), 1
    if not kind.is_linear:
        return
    for link in (2, 3):
        without = partial(_mirrored, changed(), changed(**{f"mass{link}": 2 * given[f"mass{link}"]}))
        yield f"the mass m{link} is missing", without, 2
        if link == 2 and kind.depends_on_gravity and kind.inputs == ("q",):
            words = "the third moment is taken about joint 2; it should be about joint 3"
            yield words, partial(_about_joint2, changed(), without), 1


def _mirrored(due: Callable[[], Floats], more: Callable[[], Floats]) -> Floats:
    """What is as far below what is right as another is above it: of linear quantities that may not be negative."""
    return 2 * due() - more()


def _about_joint2(due: Callable[[], Floats], of_link3: Callable[[], Floats]) -> Floats:
    """The gravity torque with what the weight of link 3 asks of joint 2 in the third entry, too."""
    return np.column_stack([due()[:, :2], of_link3()[:, 1]])
