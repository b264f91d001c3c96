"""Runs programs as they are, with other numbers for the arm's quantities, and compares them with the model."""

from __future__ import annotations

import re
import warnings
from functools import cache, lru_cache
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
from arm3r_cpp.user_functions.matlab.program import MatlabProgram
from arm3r_cpp.user_functions.programs import Call, ProgramError
from numpy.typing import NDArray

from .programs import Program

Floats = NDArray[np.float64]
NAMES = ("a2", "a3", "m2", "m3", "g")
ARMS = [(0.83, 0.57, 1.3, 2.1, 7.7), (1.21, 0.68, 0.6, 0.9, 11.3)]
STATES = np.random.default_rng(5).uniform(-2.6, 2.6, (6, 3))
INERTIA = {"lc2": 0.37, "lc3": 0.21, "I2": 0.071, "I3": 0.043}


def with_numbers(text: str, numbers: dict[str, float]) -> str:
    """The text with other numbers in the places where the quantities get theirs."""
    for name, value in numbers.items():
        text = re.sub(rf"^(\s*){name} ?= ?[\d.]+(?=;|$)", rf"\g<1>{name} = {value!r}", text, flags=re.M)
        text = re.sub(rf"; {name} = [\d.]+(?=;|$)", rf"; {name} = {value!r}", text, flags=re.M)
    for names in (("a2", "a3"), ("m2", "m3", "g")):
        joined = ", ".join(names)
        new = ", ".join(repr(numbers[name]) for name in names)
        text = re.sub(rf"^\(?{joined}\)? = [\d., ()]+$", f"{joined} = {new}", text, flags=re.M)
    return text


def values(program: Program, text: str, numbers: dict[str, float], q: Floats) -> Floats | None:
    """What the text returns at a state, with outputs in their order; None where it fails."""
    text = with_numbers(text, numbers)
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            if program.language == "matlab":
                return _matlab(text, q)
            return _python(program, text, numbers, q)
    except Exception:
        return None


@lru_cache(100)
def _function(text: str) -> Any:
    names: dict[str, Any] = {}
    exec(text, names)
    return [value for value in names.values() if callable(value)][-1]


def _python(program: Program, text: str, numbers: dict[str, float], q: Floats) -> Floats:
    function = _function(text)
    arguments = function.__code__.co_varnames[: function.__code__.co_argcount]
    q1, q2, q3 = map(float, q)  # as a program gets them: a division by zero of these raises
    every = {"q": q, "q1": q1, "q2": q2, "q3": q3, **numbers, **INERTIA}
    result = np.array(function(*(every[name] for name in arguments)), float)
    return result[::-1] if arguments[0] == "q3" and result.shape == (3,) else result


@lru_cache(100)
def _program(text: str) -> MatlabProgram:
    return MatlabProgram(text, "mutant.m")


def _matlab(text: str, q: Floats) -> Floats:
    program = _program(text)
    slots = ((0, 1, 2),) if program.arguments == ["q"] else (2, 1, 0)
    try:
        result = program.evaluate(Call(slots, {}), q[None, :])[0]
    except ProgramError:
        raise ValueError from None
    return result[::-1] if len(program.outputs) == 3 else result


def arm_of(convention: str, numbers: dict[str, float], *, with_inertia: bool = False) -> arm3r.Arm:
    return _arm_of(convention, tuple(numbers.items()), with_inertia)


@cache
def _arm_of(convention: str, items: tuple[tuple[str, float], ...], with_inertia: bool) -> arm3r.Arm:
    numbers = dict(items)
    scenario = arm3r.Scenario()
    scenario["arm.convention"] = convention
    scenario["arm.gravity"] = [0, 0, -numbers["g"]]
    for link in (2, 3):
        given: dict[str, Any] = {"shape": "slender", "length": numbers[f"a{link}"], "mass": numbers[f"m{link}"]}
        if with_inertia:
            across = INERTIA[f"I{link}"]
            given = {
                "length": numbers[f"a{link}"],
                "mass": numbers[f"m{link}"],
                "com": INERTIA[f"lc{link}"],
                "inertia": [1.3083333333333334e-05, across, across],
            }
        scenario[f"arm.link{link}"] = given
    return scenario.arm


def due(kind: str, arm: arm3r.Arm, q: Floats) -> Floats:
    function = {
        "jacobian": arm.jacobian,
        "gravity": arm.gravity_torque,
        "kinematics": arm.tip_position,
        "mass": arm.mass_matrix,
    }[kind]
    return function(q)


def returns_nothing(program: Program, text: str) -> bool:
    """Whether no number at all is finite."""
    numbers = dict(zip(NAMES, ARMS[0], strict=True))
    results = [values(program, text, numbers, q) for q in STATES]
    return not any(one is not None and np.isfinite(one).any() for one in results)


def wrong_entries(program: Program, text: str, convention: str | None = None) -> set[tuple[int, ...]] | None:
    """The entries, from 1, in which a text differs from the model; None where it fails."""
    found: set[tuple[int, ...]] = set()
    for numbers in ARMS:
        named = dict(zip(NAMES, numbers, strict=True))
        arm = arm_of(convention or program.convention, named, with_inertia=program.kind == "mass")
        for q in STATES:
            right, got = due(program.kind, arm, q), values(program, text, named, q)
            if got is None or got.shape != right.shape:
                return None
            scale = np.abs(right).max()
            for place in np.argwhere(~(np.abs(got - right) <= 1e-8 * scale)):
                found.add(tuple(int(one) + 1 for one in place))
    return found
