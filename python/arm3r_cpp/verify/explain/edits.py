"""The single edits of a program's text: one sign, name, function, number, term or factor at a time."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence

from ...user_functions.expressions import (
    All,
    AnonymousFunction,
    Binary,
    Cell,
    Compare,
    FunctionCall,
    FunctionHandle,
    Group,
    Index,
    Last,
    Logic,
    Matrix,
    Name,
    Node,
    Not,
    Number,
    Other,
    Part,
    Range,
    Root,
    Row,
    Transpose,
    Unary,
)
from ...user_functions.programs import Edit

_TRIGONOMETRIC = {"sin": "cos", "cos": "sin", "sind": "cosd", "cosd": "sind", "tan": "sin"}
_OTHER_UNIT = {"sin": "sind", "cos": "cosd", "sind": "sin", "cosd": "cos"}
"""Of MATLAB: of an angle in degrees for one in radians."""
_ADDITIVE, _MULTIPLICATIVE = ("+", "-"), ("*", "/", ".*", "./")
_COMPARISONS = ("<", "<=", ">", ">=", "==", "!=", "~=")
_MOST = 8000
_OF_DATA = 3
"""By how many ranks an edit is less likely where nothing but numbers is assigned."""


class Editor:
    """Lists the edits of a text that may mend it, the likely ones first."""

    def __init__(
        self,
        text: str,
        nodes: Sequence[Node],
        language: str,
        angles: Sequence[str],
        factors: Sequence[str],
        outputs: Sequence[str] = (),
    ) -> None:
        """
        Args:
            angles: what joint angles are called in the text, in the order of the joints.
            factors: the names of parameters.
            outputs: the names of results.
        """
        self.outputs = set(outputs)
        self.text, self.nodes, self.language = text, list(nodes), language
        self.factors = list(dict.fromkeys(factors))[:8]
        every = [inner for node in self.nodes for inner in node.walk()]
        named = (Name, FunctionCall) if language == "matlab" else (Name,)  # x(2) may be an element
        words = (one.word for one in every if isinstance(one, named) and one.word not in _TRIGONOMETRIC)
        used = list(dict.fromkeys(words))
        self.unused = [name for name in _assigned(text) if name not in used][:4]
        self.names = [*self.unused, *used][:40]
        self.trig = [one for one in every if _is_wave(one) and len(one.parts) == 1]
        self.angles = list(dict.fromkeys([*self._angle_texts(angles), *(self._of(one.parts[0]) for one in self.trig)]))[
            :14
        ]
        self.products = list(dict.fromkeys(self._of(one) for one in self._terms() if not isinstance(one, Number)))[:24]
        self.waves = [name for name in self.names if re.fullmatch(r"[csCS](_?\d{1,3}|[a-z]{0,2})", name)][:8]
        """Names such as c2, s23, ca, which stand for a cosine or a sine."""
        calls = [one for one in every if isinstance(one, FunctionCall)]
        self.called = {one.word: len(one.parts) for one in calls if re.fullmatch(r"\w+", one.word)}
        """Functions, with the number of their arguments."""
        self.power = "**" if language == "python" else "^"

    def _of(self, node: Node) -> str:
        return self.text[node.start : node.end]

    def _angle_texts(self, angles: Sequence[str]) -> list[str]:
        """Single angles, and the sums of neighbours."""
        found = list(angles)
        for first in range(len(angles)):
            for last in range(first + 2, len(angles) + 1):
                found.append("+".join(angles[first:last]))
        return found

    def _terms(self) -> Iterator[Node]:
        """The summands of all sums."""
        for statement in self.nodes:
            for node in statement.walk():
                if _is_sum(node):
                    yield from (part for part in node.parts if not _is_sum(part))
                elif isinstance(node, Root) and not _is_sum(node.parts[0]):
                    yield node.parts[0]

    def all(self, statements: Sequence[Node]) -> list[Edit]:
        """The edits of some statements, each once, without those that change nothing, the likely ones first."""
        seen, found = set(), []
        for statement in statements:
            is_data = self._is_data(statement)
            for node, parent in _with_parents(statement):
                if parent is None:
                    continue
                for edit in self._of_node(node, parent):
                    if is_data:  # a length is another number rather than none, and a formula wrong rather than both
                        if edit.new == "0":
                            continue
                        edit = edit._replace(rank=edit.rank + _OF_DATA)
                    new = " ".join(edit.new.split())
                    if (
                        new != " ".join(self.text[edit.start : edit.end].split())
                        and (edit.start, edit.end, new) not in seen
                    ):
                        seen.add((edit.start, edit.end, new))
                        found.append(edit)
        return sorted(found, key=lambda edit: edit.rank)[:_MOST]

    def _is_data(self, statement: Node) -> bool:
        """Whether a statement assigns numbers alone, in lists or by names: the arm's, which the formula uses."""
        is_whole = re.match(r"[ \t]*([\n;#%]|\Z)", self.text[statement.end :]) is not None  # no argument of a call
        name = re.match(r"\w*", self.text[statement.start : statement.parts[0].start])
        is_result = name is not None and name[0] in self.outputs
        return (
            is_whole
            and not is_result
            and all(
                isinstance(node, (Root, Number, Matrix, Row, Unary, Group))
                or (isinstance(node, Other) and node.word[:1] in ("{", "'", '"'))
                for node in statement.walk()
            )
        )

    def _of_node(self, node: Node, parent: Node) -> Iterator[Edit]:
        match node:
            case Row() | All() | Last() | Range() | Cell() | FunctionHandle() | AnonymousFunction() | Root():
                return
            case Logic() | Not():
                return
            case Compare():
                yield from self._compare(node)
                return
            case Other():
                if not isinstance(parent, Index) and not node.word.startswith(("np", "math")):
                    yield from self._wrapped(node, parent)
                return
            case Name():
                yield from self._name(node, parent)
            case Number():
                yield from self._number(node, parent)
            case Unary():
                yield from self._unary(node)
            case Binary():
                yield from self._binary(node, parent)
            case FunctionCall():
                yield from self._call(node, parent)
            case Index():
                yield from self._index(node, parent)
            case Transpose():
                yield from self._transpose(node, parent)
            case Matrix():
                yield from self._matrix(node)
        is_value = not isinstance(parent, (Index, Part, Other)) or parent.parts[:1] != (node,)
        if is_value and not (isinstance(parent, Index) and isinstance(node, Number)):
            yield from self._wrapped(node, parent)

    def _at(self, node: Node, new: str, rank: int, parent: Node | None = None) -> Edit:
        """The node's text replaced; a sum in a product gets brackets."""
        tight = parent is not None and isinstance(parent, (Binary, Unary, Transpose, Index))
        if tight and re.search(r"[-+*/]", re.sub(r"\([^()]*\)|\[[^]]*\]", "", new)):
            new = f"({new})"
        return Edit(node.start, node.end, new, rank)

    # ---- by the kind of node -----------------------------------------------------------------------------------------

    def _name(self, node: Node, parent: Node) -> Iterator[Edit]:
        is_angle = any(node in one.parts for one in self.trig)
        if is_angle:
            return  # the argument of a sine is edited with its call
        near = node.word.rstrip("0123456789")
        for name in dict.fromkeys([*self.names, *self.factors]):
            is_near = name.rstrip("0123456789") == near or name in self.unused
            likeness = 1 if is_near else 2 if name[0] == near[:1] or _are_neighbours(name, node.word) else 5
            yield self._at(node, name, likeness)
        if _is_counted(node, parent):
            yield from (self._at(node, f"{node.word}{sign}1", 3) for sign in _ADDITIVE)
        if self.trig:
            prefix = self.trig[0].word[: -len(_last(self.trig[0].word))]
            if node.word in self.angles:
                yield from (self._at(node, f"{prefix}{name}({node.word})", 4) for name in ("sin", "cos"))
                yield from (self._at(node, angle, 3, parent) for angle in self.angles)

    def _number(self, node: Number, parent: Node) -> Iterator[Edit]:
        value = node.value
        if not math.isfinite(value):
            return
        values = [0, 1, 2, 3, 4, 12, 0.5, -1, value + 1, value - 1, value / 2, 2 * value, -value, 9.80665]
        if isinstance(parent, Index) or (value == int(value) and isinstance(parent, (FunctionCall, Matrix))):
            values = [0, 1, 2, 3, value + 1, value - 1, -value]
        for new in dict.fromkeys(values):
            yield self._at(node, f"{new:.10g}", 2 if new >= 0 else 4, parent if new < 0 else None)
        yield from (self._at(node, name, 6) for name in self.factors)
        if value == 1 and not isinstance(parent, Index):
            yield from (
                self._at(node, name, 4 if name in self.waves else 5) for name in [*self.waves, *self.names[:16]]
            )
        if value == 0 and not isinstance(parent, Index):
            yield from (self._at(node, term, 4) for term in self.products)

    def _unary(self, node: Node) -> Iterator[Edit]:
        yield Edit(node.at, node.parts[0].start, "", 1)
        if node.word == "+":
            yield Edit(node.at, node.at + 1, "-", 1)

    def _binary(self, node: Node, parent: Node) -> Iterator[Edit]:
        left, right = node.parts
        for word in ("+", "-", "*", "/", self.power, *(("@",) if self.language == "python" else ("\\", "./"))):
            if word != node.word:
                yield Edit(
                    node.at, node.at + len(node.word), word, 1 if word in _ADDITIVE and node.word in _ADDITIVE else 2
                )
        yield from self._exchanged(node, parent)
        yield self._at(node, self._of(left), 3, parent)
        yield self._at(node, self._of(right) if node.word != "-" else f"-{self._of(right)}", 3, parent)
        if node.word == "@":
            yield self._at(node, f"np.linalg.solve({self._of(left)}, {self._of(right)})", 5)
        if node.word in ("-", "/", "@", "*"):
            yield self._at(node, f"{self._of(right)} {node.word} {self._of(left)}", 4, parent)
        if node.word in (*_ADDITIVE, *_MULTIPLICATIVE) and _is_sum(left):
            yield from self._regrouped(node, left, right)
        if node.word in _ADDITIVE and _is_product(left):
            inner = f"{self._of(left.parts[0])}{left.word}({self._of(left.parts[1])} {node.word} {self._of(right)})"
            yield self._at(node, inner, 5, parent if isinstance(parent, Binary) else None)

    def _exchanged(self, node: Node, parent: Node) -> Iterator[Edit]:
        """a + b + c as (a + b)*c, and a*b*c as (a + b)*c: another operator between the same parts."""
        for word in (*_ADDITIVE, "*", "/") if node.word in (*_ADDITIVE, *_MULTIPLICATIVE) else ():
            is_sum = word in _ADDITIVE
            tight = [not is_sum and _is_sum(one) for one in node.parts]
            left, right = (f"({self._of(one)})" if is_tight else self._of(one)
                           for one, is_tight in zip(node.parts, tight, strict=True))  # fmt: skip
            if any(tight) or (is_sum and node.word not in _ADDITIVE and isinstance(parent, (Binary, Unary))):
                whole = f"{left} {word} {right}"
                yield Edit(node.start, node.end, f"({whole})" if is_sum else whole, 2)

    def _regrouped(self, node: Node, left: Node, right: Node) -> Iterator[Edit]:
        """(a + b)*c as a + b*c, and a - b + c as a - (b + c)."""
        first, second = left.parts
        yield self._at(node, f"{self._of(first)} {left.word} ({self._of(second)} {node.word} {self._of(right)})", 5)

    def _compare(self, node: Node) -> Iterator[Edit]:
        known = "~=" if self.language == "python" else "!="
        yield from (Edit(node.at, node.at + len(node.word), word, 3) for word in _COMPARISONS
                    if word not in (node.word, known))  # fmt: skip

    def _index(self, node: Node, parent: Node) -> Iterator[Edit]:
        """Another angle, and v[1] + v[2] for v[2]."""
        text, base = self._of(node), self._of(node.parts[0]) if isinstance(node, Index) else node.word
        if text in self.angles and not any(node in one.parts for one in self.trig):
            yield from (self._at(node, angle, 3, parent) for angle in self.angles)
        place = node.parts[-1]
        if isinstance(place, Number) and place.word.isdigit():
            for other in (int(place.word) - 1, int(place.word) + 1):
                neighbour = f"{base}{text[place.start - node.start - 1]}{other}{text[place.end - node.start :]}"
                yield self._at(node, f"{text}+{neighbour}", 5, parent)

    def _call(self, node: Node, parent: Node) -> Iterator[Edit]:
        last, inner = _last(node.word), [self._of(part) for part in node.parts]
        if last in _TRIGONOMETRIC and len(node.parts) == 1:
            name = node.word[: -len(last)] + _TRIGONOMETRIC[last]
            yield Edit(node.at, node.at + len(node.word), name, 1)
            if self.language == "matlab" and last in _OTHER_UNIT:
                yield Edit(node.at, node.at + len(node.word), _OTHER_UNIT[last], 2)
            for angle in self.angles:
                if " ".join(angle.split()) != " ".join(inner[0].split()):
                    yield Edit(node.parts[0].start, node.parts[0].end, angle, 1)
            for angle in [one for one in self.angles if re.fullmatch(r"[\w\[\]().]+", one)]:
                bracketed = inner[0] if re.fullmatch(r"[\w\[\]().]+", inner[0]) else f"({inner[0]})"
                yield Edit(node.parts[0].start, node.parts[0].end, f"{inner[0]}+{angle}", 2)
                if angle != inner[0]:
                    yield Edit(node.parts[0].start, node.parts[0].end, f"{inner[0]}-{angle}", 2)
                    yield Edit(node.parts[0].start, node.parts[0].end, f"{angle}-{bracketed}", 3)
        others = [one for one, count in self.called.items() if count == len(node.parts) and one != node.word]
        if node.word in self.called and last not in _TRIGONOMETRIC:
            yield from (Edit(node.at, node.at + len(node.word), one, 3) for one in others[:8])
        if len(node.parts) == 1:
            yield self._at(node, inner[0], 4, parent)
            if self.language == "matlab" and last not in _TRIGONOMETRIC:
                yield from self._index(node, parent)
        if len(node.parts) == 2:
            yield Edit(node.parts[0].start, node.parts[1].end, f"{inner[1]}, {inner[0]}", 2)

    def _transpose(self, node: Node, parent: Node) -> Iterator[Edit]:
        yield self._at(node, self._of(node.parts[0]), 1, parent)
        yield from (self._at(node, name, 5) for name in self.names if isinstance(node.parts[0], Name))

    def _matrix(self, node: Node) -> Iterator[Edit]:
        """Two elements of a list, or two rows of a matrix, in the other order; the whole transposed."""
        parts = node.parts[0].parts if len(node.parts) == 1 and isinstance(node.parts[0], Row) else node.parts
        for first in range(len(parts)):
            for second in range(first + 1, len(parts)):
                one, other = parts[first], parts[second]
                yield Edit(one.start, other.end, self._of(other) + self.text[one.end : other.start] + self._of(one), 3)
        yield Edit(node.end, node.end, "'" if self.language == "matlab" else ".T", 4)

    def _rank_of_sign(self, node: Node, parent: Node) -> int:
        """A sign is lost before a whole term with its wave rather than before a factor of one."""
        is_factor = _is_product(parent)
        if isinstance(node, Name) and is_factor:
            return 4
        has_wave = any(one.word in self.waves or _is_wave(one) for one in node.walk())
        is_term = _is_product(node) and not is_factor
        return 1 if has_wave and is_term and not isinstance(parent, Unary) else 2

    # ---- for any expression ------------------------------------------------------------------------------------------

    def _wrapped(self, node: Node, parent: Node) -> Iterator[Edit]:
        text = self._of(node)
        is_atom = isinstance(node, (Name, Number, FunctionCall, Index, Group, Matrix))
        whole = text if is_atom else f"({text})"
        is_sum, is_binary = _is_sum(node), isinstance(node, Binary)
        if not isinstance(node, Number) and not isinstance(parent, Transpose):
            if not isinstance(parent, Unary):
                rank = self._rank_of_sign(node, parent)
                is_product = is_binary and rank > 1  # whose first factor is no negative number
                yield self._at(node, f"-{whole if is_sum or is_product else text}", rank, parent)
            yield self._at(node, "0", 3)
            yield self._at(node, "1", 4)
        if isinstance(node, (Name, FunctionCall, Other, Index)) or (
            is_binary and not isinstance(parent, (Binary, Unary))
        ):
            for factor in self.factors:
                yield Edit(node.start, node.end, f"{factor}*{whole}", 4)
                yield self._at(node, f"{whole}/{factor}", 6, parent if isinstance(parent, Binary) else None)
            yield self._at(node, f"{whole}/2", 3, parent if isinstance(parent, Binary) else None)
            yield Edit(node.start, node.end, f"2*{whole}", 3)
            yield self._at(node, f"{whole}{self.power}2", 4)
            for call in dict.fromkeys(f"{one.word}({self._of(one.parts[0])})" for one in self.trig):
                yield Edit(node.start, node.end, f"{whole}*{call}", 5)
            yield from (Edit(node.start, node.end, f"{whole}*{name}", 5) for name in self.waves)
        brackets = isinstance(parent, Binary) and not is_sum
        if brackets or isinstance(parent, (Root, Group, Matrix, Row)):
            for term in self.products:
                for sign in _ADDITIVE if term != text else "+":
                    body = f"{text} {sign} {term}"
                    yield Edit(node.start, node.end, f"({body})" if brackets else body, 5)
        is_named = isinstance(node, (Name, FunctionCall))
        if self.language == "python" and (is_named or isinstance(node, Index)) and isinstance(parent, (Binary, Root)):
            yield Edit(node.end, node.end, ".T", 6)
        elif self.language == "matlab" and (is_named or isinstance(node, Group)):
            yield Edit(node.end, node.end, "'", 6)


def _assigned(text: str) -> list[str]:
    """The names on the left of assignments: one that is used nowhere may be the one that was meant."""
    sides = re.findall(r"(?:^|;)[ \t]*([\w\[\](), ]+?)\s*=(?!=)", text, re.M)
    return list(
        dict.fromkeys(re.findall(r"(?<![\w.\[(])[A-Za-z]\w*", re.sub(r"\b(def|function)\b", "", " ".join(sides))))
    )


def _are_neighbours(name: str, other: str) -> bool:
    """Whether two names are letters that follow each other: a and b."""
    return len(name) == len(other) == 1 and abs(ord(name) - ord(other)) == 1


def _is_counted(node: Node, parent: Node) -> bool:
    """Whether a name counts elements: in an index, a slice or a range."""
    if isinstance(parent, Index):
        return node is not parent.parts[0]
    is_slice = isinstance(parent, Other) and re.fullmatch(r"[^\n{]*:[^\n{]*", parent.word) is not None
    is_range = isinstance(parent, Range) or (isinstance(parent, FunctionCall) and _last(parent.word) == "range")
    return is_slice or is_range


def _last(word: str) -> str:
    return word.rsplit(".", 1)[-1]


def _is_sum(node: Node) -> bool:
    return isinstance(node, Binary) and node.word in _ADDITIVE


def _is_product(node: Node) -> bool:
    return isinstance(node, Binary) and node.word in _MULTIPLICATIVE


def _is_wave(node: Node) -> bool:
    """Whether it is a sine, a cosine or a tangent."""
    return isinstance(node, FunctionCall) and _last(node.word) in _TRIGONOMETRIC


def _with_parents(node: Node) -> Iterator[tuple[Node, Node | None]]:
    """A node and all in it, in the order of `walk`."""
    left: list[tuple[Node, Node | None]] = [(node, None)]
    while left:
        inner, parent = left.pop()
        yield inner, parent
        left.extend((part, inner) for part in reversed(inner.parts))
