"""What to do about a chain that is no elbow arm: joints to lock elsewhere, or axes to take as those of one."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..errors import UsageError
from .choice import Choice, chosen, held_positions
from .elbow import Misfit, as_elbow, misfit
from .serial import Serial, serial_chain
from .urdf import Urdf

_LOCKS = {"0": 0.0, "90 deg": math.pi / 2, "-90 deg": -math.pi / 2, "180 deg": math.pi}
_SMALL = math.radians(3.0)
"""Axes that are off by more are not meant to be those of an elbow arm."""


def conforming(urdf: Urdf, choice: Choice) -> Serial:
    """The chosen chain, whose axes are those of an elbow arm within the tolerance.

    Raises:
        UsageError: the choice is none, or the axes are others; the message says what would help.
    """
    chain = chosen(urdf, choice)
    found = misfit(chain)
    if max(found) <= choice.axis_tolerance:
        return chain
    one, two, three = (joint.name for joint in chain.joints)
    if found.across > choice.axis_tolerance:
        fault = f"the axes of {one} and {two} are {90 - math.degrees(found.across):.6g} deg apart"
        rule = "an elbow arm needs them at 90 deg"
    else:
        fault = f"the axes of {two} and {three} are {math.degrees(found.parallel):.4g} deg apart"
        rule = "an elbow arm needs them parallel"
    within = f"{rule} within axis_tolerance, {choice.axis_tolerance:.2g} rad"
    help_ = _other_locks(urdf, chain, choice) or _wider_tolerance(chain, found, urdf.file)
    raise UsageError(f"{urdf.file}: {fault}; {within}{help_}")


def _other_locks(urdf: Urdf, chain: Serial, choice: Choice) -> str:
    """Positions of locked joints that make the chain an elbow arm, one joint at a time."""
    found = []
    for name, position in choice.lock.items():
        joint = urdf.joint(name)
        if joint.kind == "prismatic":
            continue
        good = [
            words
            for words, other in _LOCKS.items()
            if max(misfit(serial_chain(urdf, chain.tip, held_positions(urdf, {**choice.lock, name: other}))))
            <= choice.axis_tolerance
        ]
        if good:
            found.append(f"{name} at {_alternatives(good)} instead of {position:.6g} rad")
    return f"; lock {_alternatives(found)}" if found else ""


def _wider_tolerance(chain: Serial, found: Misfit, file: str) -> str:
    """Which tolerance takes the chain as it is, and what that costs."""
    if max(found) > _SMALL:
        return ""
    cost = tip_error(chain, file)
    return f"; axis_tolerance: {_rounded_up(max(found))} takes them so; the tip is then up to {1e3 * cost:.2g} mm off"


def tip_error(chain: Serial, file: str) -> float:
    """The largest distance of the elbow arm's tip from that of the chain, over random poses, m."""
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (1000, 3))
    return float(np.linalg.norm(chain.tip_position(q) - as_elbow(chain, file).tip_position(q), axis=1).max())


def _rounded_up(angle: float) -> str:
    """With two digits, such as 0.0067."""
    step = 10.0 ** (math.floor(math.log10(angle)) - 1)
    return f"{math.ceil(angle / step) * step:.2g}"


def _alternatives(words: Sequence[str]) -> str:
    """ "0, 90 deg or 180 deg"."""
    *most, last = words
    return f"{', '.join(most)} or {last}" if most else last
