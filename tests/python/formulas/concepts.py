"""Mistakes of understanding: which right formula, and what in it is thought of in another way.

A concept is a list of replacements, regular expressions in the text of a program. Each place where one fits makes a
mutant, and where there are several, all of them at once make another. Whether a mutant computes something else, and
what, is found by running it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from .mistakes import singles, wrong_text
from .outcomes import FILES, FOLDER, kind_of


class Mutant(NamedTuple):
    concept: str
    path: Path
    """Of the right program."""
    text: str


INERTIAL = ("mass", "coriolis", "inverse", "forward")
_DYNAMICS = ("gravity", *INERTIAL)
_RATES = ("coriolis", "inverse", "forward", "jacobian_dot")
_SUM = r"\b(\w+?)([\[(]?)([12])([\])]?) ?\+ ?\1\2([23])\4(?![\d*(\[])"
"""The absolute angle of link 3: q2 + q3, q[1] + q[2], th(2)+th(3)."""
_LEVEL = r"(?:[^\n()\[\]]|\([^\n()]*\)|\[[^\n\[\]]*\])"
"""A letter, or what stands in brackets."""
_INNER = r"(?:[^(),]|\[[^\]]*\]|\([^()]*\))+?"
"""An argument."""
_OTHER = {"sin": "cos", "cos": "sin", "s": "c", "c": "s"}

Replacement = tuple[str, str]
_CONCEPTS: dict[str, tuple[tuple[str, ...], tuple[Replacement, ...]]] = {
    "the relative angle for the absolute one": ((), ((_SUM, r"\1\2\5\4"),)),
    "a stale angle": ((), ((_SUM, r"\1\2\3\4"), (r"\bc23\b(?! ?[,=])", "c2"), (r"\bs23\b(?! ?[,=])", "s2"))),
    "the angle is turned the other way": ((), ((_SUM, r"\1\2\3\4 - \1\2\5\4"),)),
    "another joint's angle": ((), ((r"\bq\[1\]", "q[2]"), (r"\bq\(2\)", "q(3)"), (r"(?<=[(])q2\b(?=\))", "q3"))),
    "degrees for radians": (
        (),
        (
            (r"\b(np\.cos|np\.sin)\(([\w\[\] +]+)\)", r"\1(np.deg2rad(\2))"),
            (r"(?<![.\w])(cos|sin)(?=\()", r"\1d"),
            (r"np\.pi/180\*|\*np\.pi/180|\*pi/180", ""),
        ),
    ),
    "the centre of mass at the link's end": (
        _DYNAMICS,
        (
            (r"\b0\.37\b", "0.8"),
            (r"\b0\.21\b", "0.55"),
            (r"\blc2\b(?! ?[,=])", "a2"),
            (r"(?<=a)([23])/2\b", r"\1"),
            (r"(?<=l)([23])/2\b", r"\1"),
        ),
    ),
    "the centre of mass for the link's end": (_DYNAMICS, ((r"\b0\.8\b", "0.37"),)),
    "the other link's centre of mass": (_DYNAMICS, ((r"\b0\.21\b", "0.37"), (r"\blc3\b(?! ?[,=])", "lc2"))),
    "the other link's length": (
        ("jacobian", "kinematics", "jacobian_dot"),
        (
            (r"\b0\.55\b", "0.8"),
            (r"\b0\.8\b", "0.55"),
            (r"\b(a|A|l|L)3\b(?! ?[,=])", r"\g<1>2"),
            (r"\b(a|A|l|L)2\b(?! ?[,=])", r"\g<1>3"),
        ),
    ),
    "the other link's mass": (
        _DYNAMICS,
        (
            (r"\b2\.1\b", "1.3"),
            (r"\b1\.3\b", "2.1"),
            (r"\b(m|M)3\b(?! ?[,=])", r"\g<1>2"),
            (r"\b(m|W)2\b(?! ?[,=])", r"\g<1>3"),
        ),
    ),
    "another g": (_DYNAMICS, ((r"\b9\.80665\b", "9.81"), (r"\b9\.80665\b", "9.8"), (r"\b9\.80665\b", "10"))),
    "g is missing": (_DYNAMICS, ((r"\b(9\.80665|g0?)\*", ""), (r"\*(9\.80665|g0?)\b", ""))),
    "the sign of gravity": (
        _DYNAMICS,
        (
            (r"-(?=9\.80665)", ""),
            (r"(?<![-\d,*])(?<!- )\b9\.80665\b", "-9.80665"),
            (r"-(?=g0?\b)", ""),
            (r"([-+]) G\b", " G"),
            (r"- G\b", "+ G"),
            (r"\+ G\b", "- G"),
        ),
    ),
    "the parallel axes twice": (
        INERTIAL,
        (
            (r"\b0\.071\b", "(0.071 + 1.3*0.37*0.37)"),
            (r"\b0\.043\b", "(0.043 + 2.1*0.21*0.21)"),
            (r"\bI2\b(?! ?[,=])", "(I2 + m2*0.37*0.37)"),
        ),
    ),
    "no parallel axes": (INERTIAL, ((r" ?\+ ?1\.3\*0\.37(\*\*|\^)2", ""), (r" ?\+ ?2\.1\*0\.21(\*\*|\^)2", ""))),
    "no inertia about the centre": (INERTIAL, ((r"\b0\.071 ?[-+] ", ""), (r"\b0\.043\b", "0"), (r"\b0\.071\b", "0"))),
    "the other link's inertia": (INERTIAL, ((r"\b0\.043\b", "0.071"), (r"\b0\.071\b", "0.043"))),
    "a sphere for a rod": (INERTIAL, ((r"\b0\.002\b", "0.071"), (r"\b0\.003\b", "0.043"))),
    "the carried link is left out": (INERTIAL, ((r" ?\+ ?2\.1\*0\.8(\*\*|\^)2", ""),)),
    "a missing factor 2": ((), ((r"(?<![\w.*^/])2\*(?=[A-Za-z(])", ""),)),
    "a missing half": (_DYNAMICS, ((r"/2\b(?!\.)", ""), (r"\b0\.5\*", ""))),
    "a missing square": (_DYNAMICS, ((r"(\*\*|\.?\^)2\b", ""),)),
    "no coupling of the rates": (
        _RATES,
        (
            (r"\b2\*(qd\(?\[?\d\]?\)?|w2) ?\+ ?", ""),
            (r"\((2?\*?qd\(?\[?\d\]?\)?) ?\+ ?(qd\(?\[?\d\]?\)?)\)", r"\1"),
            (r"\b(qd[\[(]?)([12])([\])]?) ?\+ ?\1([23])\3", r"\1\4\3"),
            (r"(w|qd|v)2\*\1\d", r"\g<1>2"),
        ),
    ),
    "another joint's rate": (
        _RATES,
        (
            (r"\bqd\(2\)", "qd(3)"),
            (r"\bqd\[1\]", "qd[2]"),
            (r"\bqd2\b(?! ?[,=])", "qd3"),
            (r"\bqd\(1\)", "qd(2)"),
            (r"\bqdd\(2\)", "qdd(3)"),
            (r"\bqdd\[1\]", "qdd[2]"),
        ),
    ),
    "an index of Christoffel": (
        _RATES,
        (
            (r"\[([ijk])\]\[([ijk]), ?([ijk])\]", r"[\2][\1, \3]"),
            (r"- (?=dM?\w*\[i\]|D\[i\])", "+ "),
            (r"'jki->ijk'", "'ikj->ijk'"),
            (r"'kij->ijk'", "'jik->ijk'"),
        ),
    ),
    "a product the other way round": (
        (),
        (
            (r"cross\(([^(),]+), ?([^(),]+)\)", r"cross(\2, \1)"),
            (r"\b(\w+) @ (\w+)\b(?![\[(.])", r"\2 @ \1"),
            (r"\b([RT]\w*)\*(rot\w+\([^()]*\([^()]*\)[^()]*\))", r"\2*\1"),
        ),
    ),
    "the moment about another point": (
        (),
        (
            (rf"(cross\({_INNER},|hat\(z\) @ \()( ?\w+(\{{4\}}\(1:3,4\))?) ?- ?{_INNER}\)", r"\1\2)"),
            (r"(cross\([ny], ?)([pl])3\)", r"\1\g<2>2 + \g<2>3)"),
            (r"(?<=cross\()(0\.8|a2)(?=\*u)", "0.37"),
        ),
    ),
    "a transpose is forgotten": ((), ((r"(?<=[\w\])])\.T\b", ""), (r"(?<=[\])\w])\.?'(?=[;*) \n])(?! *[,\]])", ""))),
    "another link's frame": (
        (),
        (
            (r"\bT2\b(?! ?[,=])", "T1"),
            (r"\bT3\b(?! ?[,=])", "T2"),
            (r"\bR2\b(?! ?[,=])", "R1"),
            (r"\bR3\b(?! ?[,=])", "R2"),
            (r"\b(E|u|r|J|Jv|Jw)3\b(?! ?[,=])", r"\g<1>2"),
        ),
    ),
    "another axis": (
        (),
        (
            (r"\b([Rr]ot|R)y\((?=[^t])", r"\1z("),
            (r"\b([Rr]ot|R)z\((?=[^t])", r"\1y("),
            (r"(?<=[^-])pi/2", "-pi/2"),
            (r"-(?=(np\.)?pi/2)", ""),
        ),
    ),
    "the other sign of a row": ((), ((r"(?<=[\[;,])( ?)-(?=[\w(])", r"\1"), (r"(?<=return )-", ""))),
    "the last term is lost": ((), ((r" ?[+] ?[^-+()\[\],;=\n]+(?=;?$)", ""), (r" \.\.\.\n[^;\n]*(?=;)", ""))),
    "a lost continuation": (
        (),
        ((rf"^( *)(\w[^\n=]* ?[-+]?= ?[^\n]*?) ([-+]) ({_LEVEL}+?)(;?)$", r"\1\2\n\1\3 \4\5"),),
    ),
    "an index too few": ((), ((r"\b([ijk]) ?\+ ?1\b", r"\1"), (r">= j", "> j"), (r"\bk\+1\b", "k"))),
    "not added up": ((), ((r"(?<=\S )\+=", "="), (r"np\.cumsum\(([^()]+)\)", r"\1"), (r"-=", "+="))),
    "sine for cosine": ((), ((r"\b(sin|cos)(?=\()", "OTHER"), (r"(?<=\*)([cs])(?=\d+\b)", "OTHER"))),
    "without the base's height": (("kinematics",), ((r"\b0\.25\b", "0"), (r"\bd1\b(?! ?[,=])", "0"))),
}


def mutants() -> list[Mutant]:
    """All that differ from the program and from each other, those by hand first."""
    every = [*_by_hand(), *(one for path in FILES for one in _of_program(path))]
    return list({(one.path, one.text): one for one in reversed(every)}.values())[::-1]


def style(path: Path) -> str:
    return path.stem.removeprefix(kind_of(path)).strip("_")


def _by_hand() -> Iterator[Mutant]:
    for one in singles():
        path = FOLDER / one.file
        yield Mutant("by hand", path, wrong_text(path.read_text(), one))


def _of_program(path: Path) -> Iterator[Mutant]:
    text = path.read_text()
    for concept, (kinds, replacements) in _CONCEPTS.items():
        if kinds and kind_of(path) not in kinds:
            continue
        for pattern, new in replacements:
            for wrong in _replaced(text, re.compile(pattern, re.M), new):
                if wrong != text:
                    yield Mutant(concept, path, wrong)


def _replaced(text: str, pattern: re.Pattern[str], new: str) -> Iterator[str]:
    """The text with a replacement at each of its places, and at all."""
    places = list(pattern.finditer(text))
    for place in places:
        yield text[: place.start()] + _new(place, new) + text[place.end() :]
    if len(places) > 1:
        yield pattern.sub(lambda place: _new(place, new), text)


def _new(place: re.Match[str], new: str) -> str:
    return _OTHER[place[0]] if new == "OTHER" else place.expand(new)
