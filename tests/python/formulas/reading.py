"""What a verdict says, evaluated without the package."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_WAVE = re.compile(r"([SC])(\d+)$")


def value(sentence: str, q: Floats, parameters: dict[str, float]) -> float:
    """The value of "-a3 S1 S23 + 1/2 m2 g C2" at joint angles."""
    total = 0.0
    for sign, term in re.findall(r"(^-?|[+-] )((?:[^ +-]|\((?:[^)]*)\)|(?<=e)-| (?![+-]))+)", _closed(sentence)):
        product = -1.0 if "-" in sign else 1.0
        for word in term.split():
            first, *denominators = [word] if re.fullmatch(r"\d+/\d+", word) else re.split(r"/(?=[a-zA-Z])", word)
            product *= _factor(first, q, parameters)
            for name in denominators:
                product /= parameters[name]
        total += product
    return total


_MEASURED = re.compile(r"\(([\d.]+) \+- ([\d.]+)\)")


def interval(sentence: str, q: Floats, parameters: dict[str, float]) -> tuple[float, float]:
    """The value of "(0.499 +- 0.002) a2 C2 - a3 S23", and by how much it may be another."""
    numbers = _MEASURED.findall(sentence)

    def at(changed: int) -> float:
        texts = iter([str(float(value) + (place == changed) * float(allowed))
                      for place, (value, allowed) in enumerate(numbers)])  # fmt: skip
        return value(_MEASURED.sub(lambda _: next(texts), sentence), q, parameters)

    return at(-1), sum(abs(at(place) - at(-1)) for place in range(len(numbers)))


def _closed(sentence: str) -> str:
    """Without blanks inside brackets, and with words for the signs there."""
    return re.sub(
        r"\(([^)]*)\)",
        lambda found: "(" + found[1].replace(" ", "").replace("-", "~").replace("+", "&") + ")",
        sentence,
    )


def _factor(word: str, q: Floats, parameters: dict[str, float]) -> float:
    wave = _WAVE.match(word)
    if wave and word not in parameters:
        angle = sum(q[int(digit) - 1] for digit in wave[2])
        return float(np.sin(angle) if wave[1] == "S" else np.cos(angle))
    call = re.match(r"(sin|cos)\((.*)\)$", word)
    if call:
        inner = call[2].removesuffix("deg").replace("~", "-").replace("&", "+")
        inner = re.sub(r"(\d)(q)", r"\1*\2", inner)
        angle = eval(inner, {f"q{n + 1}": q[n] for n in range(len(q))})
        angle = np.deg2rad(angle) if call[2].endswith("deg") else angle
        return float(np.sin(angle) if call[1] == "sin" else np.cos(angle))
    name, _, power = word.partition("^")
    if name in parameters:
        return float(parameters[name] ** int(power or 1))
    if re.fullmatch(r"q\d", name):
        return float(q[int(name[1]) - 1] ** int(power or 1))
    numerator, _, denominator = word.partition("/")
    return float(numerator) / float(denominator or 1)


def with_edits(text: str, findings: list[Any]) -> str:
    """The text after the edits that findings name, at the places that they name."""
    lines = text.split("\n")
    starts = {}
    for one in findings:
        if one.old is not None:
            starts[sum(len(line) + 1 for line in lines[: one.line - 1]) + one.column - 1] = one
    for start, one in sorted(starts.items(), reverse=True):
        assert text[start : start + len(one.old)] == one.old
        text = text[:start] + one.new + text[start + len(one.old) :]
    return text
