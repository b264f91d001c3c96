"""What both formats share: numbers, comments and the text of a document."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable
from xml.etree.ElementTree import Element

NO_LIMIT = 1e9
"""N m or N: stands for no limit, where a format needs a number."""


def numbers(*values: float) -> str:
    """With as many digits as give the same numbers again."""
    return " ".join(repr(float(value) + 0.0).removesuffix(".0") for value in values)  # + 0.0: -0 becomes 0


def units(convention: str) -> str:
    """The first comment."""
    return f"Units: m, kg, s, rad. Joint angles, rates and torques are those of arm.convention {convention}."


def document(root: Element, comments: Iterable[str]) -> str:
    """The whole file: the comments are its first lines."""
    for place, comment in enumerate(comments):
        root.insert(place, ElementTree.Comment(f" {comment} "))
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"
