"""The keys of an elbow arm as text, each with the joint or the links that it comes from."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np

from .._messages import shown, warn_user
from .._native import Floats
from ..errors import ScenarioWarning, UsageError
from .bodies import Body
from .choice import Choice, listed
from .elbow import Elbow, as_elbow, misfit
from .remedy import conforming, tip_error
from .serial import Serial
from .urdf import Urdf


class OwnArm(NamedTuple):
    """An arm of a URDF."""

    elbow: Elbow
    chain: Serial
    text: str
    """Its keys, those under `arm:`."""


def explicit_arm(request: Mapping[str, Any]) -> str:
    """The keys of an elbow arm, as YAML: what stands under `arm:`, in the place of `urdf` and what is beside it.

    Args:
        request: see `Choice.of`.

    Raises:
        UsageError: the file cannot be read, or its chain is no elbow arm.
    """
    return own_arm(Choice.of(request)).text


def answer(request: str) -> tuple[int, str]:
    """What the reader of `arm.urdf` gives back (arm3r.h): 0 and keys as YAML, or 1 and a sentence of what is wrong."""
    try:
        return 0, explicit_arm(json.loads(request))
    except (UsageError, ScenarioWarning) as error:  # a warning where Python was told to raise them
        return 1, str(error)


def own_arm(choice: Choice) -> OwnArm:
    """The arm that is chosen of a URDF; warns of what the file leaves open.

    Raises:
        UsageError: the file cannot be read, or its chain is no elbow arm.
    """
    urdf = Urdf(choice.file)
    chain = conforming(urdf, choice)
    elbow = as_elbow(chain, urdf.file)
    for number, (body, links) in enumerate(zip(elbow.bodies, chain.links, strict=True), start=1):
        missing = [key for key in ("mass", "com", "inertia") if f"link{number}.{key}" not in choice.given]
        if number > 1 and body.mass == 0 and missing:
            what = "mass" if urdf.has_inertial(links[0]) else "<inertial>"
            keys = f"arm.link{number}.{', '.join(missing)}"
            raise UsageError(f"{urdf.file}: {links[0]} has no {what}: give {keys} beside arm.urdf")
    for sentence in _doubts(urdf, chain):
        warn_user(f"{urdf.file}: {sentence}", ScenarioWarning)
    text = _text(elbow, chain, urdf.file)
    if choice.given.issuperset(_paths(text)):
        said = "all that it says of the arm is given beside arm.urdf, and replaces it"
        raise UsageError(f"{urdf.file}: nothing of this file is used: {said}; take those keys of the arm out")
    return OwnArm(elbow, chain, text)


def _paths(text: str) -> Iterator[str]:
    """Those of the keys: "model", "link2", "link2.mass"."""
    section = ""
    for blanks, key in re.findall(r"^( *)(\w+):", text, re.M):
        section = section if blanks else key
        yield f"{section}.{key}" if blanks else key


def _doubts(urdf: Urdf, chain: Serial) -> Iterable[str]:
    """What the file leaves open, in sentences."""
    idle = [joint.name for joint in chain.joints if joint.effort is not None and joint.effort <= 0]
    if idle:
        yield f"effort of {listed(idle)} is 0: taken as no limit of torque; arm.torque_limit sets one"
    if chain.held:
        yield f"held at zero beside the way to {chain.tip}: {', '.join(chain.held)}; lock sets other positions"
    bodies = {link: urdf.body(link) for links in chain.links for link in links if urdf.has_inertial(link)}
    some = next(iter(bodies.values()), None)
    if some and len(bodies) > 2 and all(_has_numbers_of(some, other) for other in bodies.values()):
        yield (
            f"{', '.join(bodies)} all have the mass {some.mass:g} kg and one inertia: these are placeholders, and "
            "forces and motions mean nothing before you give masses"
        )
    angle = max(misfit(chain))
    if angle > 1e-6:
        cost = 1e3 * tip_error(chain, urdf.file)
        yield f"the axes are taken as those of an elbow arm, {angle:.2g} rad off; the tip is up to {cost:.2g} mm off"


def _has_numbers_of(one: Body, other: Body) -> bool:
    principal, others = (np.linalg.eigvalsh(body.inertia) for body in (one, other))
    return one.mass == other.mass and np.allclose(principal, others, rtol=1e-9, atol=0.0)


def _text(elbow: Elbow, chain: Serial, file: str) -> str:
    geometry: tuple[list[str], ...] = (
        [],
        [f"length: {number(elbow.length)}", f"offset: {number(elbow.offset)}"],
        [f"tip: {_row(elbow.tip)}"],
    )
    lines = [
        "model: elbow",
        note(f"angles, rates and torques of {os.path.basename(file)}"),
        "convention: urdf",
        note(f"joints: {', '.join(joint.name for joint in chain.joints)}"),
        f"joint_zero: {_row(elbow.joint_zero)}",
        f"joint_sign: {_row(elbow.joint_sign)}",
        f"base: {{position: {_row(elbow.base_position)}, rotation: {_row(elbow.base_rotation)}}}",
        f"shoulder_offset: {number(elbow.shoulder_offset)}",
    ]
    for place, (keys, body, links) in enumerate(zip(geometry, elbow.bodies, chain.links, strict=True), start=1):
        keys += _body_lines(body) if body.mass or body.inertia.any() else []
        lines += [note(", ".join(links)), f"link{place}:", *(f"  {key}" for key in keys)] if keys else []
    lines += [f"{key}: {_row(values)}" for key, values in _joint_keys(chain).items()]
    return "\n".join(lines) + "\n"


def note(text: str) -> str:
    """As a comment."""
    return fill(
        shown(text), 110, initial_indent="# ", subsequent_indent="# ", break_long_words=False, break_on_hyphens=False
    )


def _body_lines(body: Body) -> list[str]:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.inertia
    size = float(np.abs(body.inertia).max())
    diagonal, products = (", ".join(number(one, size) for one in part) for part in ([xx, yy, zz], [xy, xz, yz]))
    return [
        f"mass: {number(body.mass, body.mass)}",
        f"com: {_row(body.centre)}",
        f"inertia: [{diagonal},",
        f"          {products}]",
    ]


def _joint_keys(chain: Serial) -> dict[str, list[float]]:
    """Damping, friction and limits, where the file gives some."""
    limits = [joint.effort if joint.effort and joint.effort > 0 else np.inf for joint in chain.joints]
    found = {
        "damping": [joint.damping for joint in chain.joints],
        "friction": [joint.friction for joint in chain.joints],
        "torque_limit": limits,
    }
    absent = {"damping": 0.0, "friction": 0.0, "torque_limit": np.inf}
    return {key: values for key, values in found.items() if any(value != absent[key] for value in values)}


def _row(values: Iterable[float] | Floats) -> str:
    return f"[{', '.join(map(number, values))}]"


def number(value: float, size: float = 1.0) -> str:
    """As YAML: a short text, where it is one of the number but for the rounding of a computation with its size."""
    short = f"{value:.12g}"
    text = short if abs(float(short) - value) <= 4e-16 * size or value == float(short) else repr(float(value))
    return text.replace("e", ".0e") if "e" in text and "." not in text else text
