"""The units in which logs give numbers: how people write them, and their factors to SI units and radians."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import NamedTuple


class Unit(NamedTuple):
    factor: float
    """By which its numbers are multiplied."""
    seconds: int
    """The power of time that it is written with: -2 for deg/s^2, 0 for N m."""


_TURN = 2 * math.pi
_WORDS: dict[int, dict[float, str]] = {  # by the power of time, and the factor
    0: {
        1.0: "rad radian radians m meter meters metre metres N newton newtons Nm Nms kg kgm",
        1e-2: "cm Ncm",
        1e-3: "mrad mm mN mNm Nmm",
        1e-6: "urad um uNm",
        1e3: "kN kNm",
        _TURN: "rev revs revolution revolutions turn turns",
        _TURN / 360: "deg degs degree degrees °",
    },
    1: {1.0: "s sec secs second seconds", 1e-3: "ms msec", 1e-6: "us", 1e-9: "ns", 60.0: "min minute minutes"},
    -1: {1.0: "radps", _TURN / 360: "dps degps", _TURN / 60: "rpm"},
}
_UNITS = {
    word.lower(): Unit(factor, seconds)
    for seconds, units in _WORDS.items()
    for factor, words in units.items()
    for word in words.split()
}
_SAME = {"r/min": "rpm", "u/min": "rpm", "1/min": "rpm", "min-1": "rpm"}
_SIGNS = str.maketrans({**dict(zip("¹²³⁻−·⋅×µμº", "123--***uu°", strict=True)), **dict.fromkeys("^(){}")})
_PER = re.compile(r"[\s_]+per[\s_]+|_(?=(?:s|sec|min)\d?(?:_|$))", re.IGNORECASE)
_NUMBER = re.compile(r"(\d+(?:\.\d+)?(?:e[-+]?\d+)?)\s*\*?\s*(?=[^\W\d_]|°)", re.IGNORECASE)
_TERM = re.compile(
    rf"(^|\s*[/*._-]\s*|\s+)({'|'.join(sorted(_UNITS, key=len, reverse=True))})([-+]?\d)?(?![^\W_]|°)", re.IGNORECASE
)


@cache
def unit_of(text: str) -> Unit | None:
    """The unit that a text means: deg/s^2, deg_s2, rad.s-1, N-m, mNm, rpm, 0.01 deg; None where it is not known."""
    text = text.replace("**", "").translate(_SIGNS).strip().rstrip(".")
    text = _SAME.get(text.lower(), text)
    if text in ("", "-"):
        return Unit(1.0, 0)
    number = _NUMBER.match(text)
    factor, seconds = float(number[1]) if number else 1.0, 0
    text = _PER.sub("/", text[number.end() :] if number else text)
    end = 0
    while end < len(text):
        term = _TERM.match(text, end)
        if term is None or term[2].startswith("MN"):  # mega, or milli in capital letters
            return None
        unit, power = _UNITS[term[2].lower()], int(term[3] or 1) * (-1 if "/" in term[1] else 1)
        factor, seconds = factor * unit.factor**power, seconds + power * unit.seconds
        end = term.end()
    return Unit(factor, seconds)
