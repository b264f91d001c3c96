"""The reference pages of the C and C++ headers, written from the headers themselves: text from their comments."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
HEADER = ROOT / "cpp/include/arm3r/arm3r.h"
TEMPLATES = ROOT / "cpp/include/arm3r"
ROOMS = ["model", "control", "sensing", "ode", "numbers"]

# A comment, a line of the preprocessor, a blank line, or a declaration that ends at its semicolon.
C_PIECE = re.compile(
    r"""(?P<comment>/\*.*?\*/)[ \t]*\n
    | (?P<preprocessor>\#.*?(?<!\\)\n) | (?P<blank>\n) | (?P<extern>extern\ "C"\ \{\n|\}\n)
    | (?P<declaration>[a-zA-Z](?:/\*.*?\*/|[^;{/]|\{.*?\}|/(?!\*))*;)(?P<after>[ \t]*(?:/\*.*?\*/)?\n)""",
    re.S | re.X,
)
SECTION = re.compile(r"---- (.*?) -{4,}\s*(.*)", re.S)


class Declaration(NamedTuple):
    """One declaration of the C header and what its comments say."""

    text: str
    comment: str

    @property
    def kind(self) -> str:
        for kind in ("enum", "struct"):
            if re.match(rf"(typedef )?{kind}\b.*\{{", self.text, re.S):
                return kind
        return "type" if self.text.startswith("typedef") else "function"

    @property
    def signature(self) -> str:
        """For Sphinx's C domain."""
        if self.kind in ("enum", "struct"):
            name = re.search(r"\}\s*(\w+);$", self.text) or re.search(r"(ARM3R_\w+)", self.text)
            return name[1] if name else ""
        bare = re.sub(r"/\*.*?\*/|ARM3R_API |^typedef |;$", "", self.text)
        return " ".join(re.sub(r"^struct \w+ (?=\w+$)", "", bare).split()).replace("( ", "(").replace(" )", ")")


def words(comment: str) -> str:
    """The text of a comment without its marks."""
    inner = re.sub(r"^/\*|\*/$", "", comment.strip())
    return "\n".join(re.sub(r"^\s*\*? ?", "", line).rstrip() for line in inner.splitlines()).strip()


def pieces(header: str) -> Iterator[str | Declaration]:
    """Comments that stand alone, and declarations with theirs, in their order."""
    waiting = ""
    at = 0
    while at < len(header):
        piece = C_PIECE.match(header, at)
        if not piece:
            raise ValueError(f"arm3r.h cannot be read from here: {header[at : at + 80]!r}")
        at = piece.end()
        if piece["declaration"]:
            comments = [words(text) for text in (waiting, piece["after"].strip()) if text]
            yield Declaration(piece["declaration"], "\n\n".join(comments))
            waiting = ""
        else:
            if waiting:
                yield words(waiting)
            waiting = piece["comment"] or ""


def escaped(text: str) -> str:
    """Plain text as Markdown; what stands between backticks is code there, too."""
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(part if part.startswith("`") else re.sub(r"([\\*_\[\]<>|$])", r"\\\1", part) for part in parts)


def c_page(header: str) -> str:
    """The C reference, as MyST Markdown."""
    lines = ["# C interface\n", "Everything below is written from `arm3r/arm3r.h`, which the package installs.\n"]
    for piece in pieces(header):
        if isinstance(piece, Declaration):
            lines += c_entry(piece)
        elif section := SECTION.match(piece):
            lines += [f"## {section[1].capitalize()}\n", escaped(section[2]) + "\n"]
        else:
            lines.append(escaped(piece) + "\n")
    return "\n".join(lines)


def c_entry(declaration: Declaration) -> list[str]:
    entry = [f"````{{c:{declaration.kind}}} {declaration.signature}\n", escaped(declaration.comment) + "\n"]
    if declaration.kind in ("enum", "struct"):
        entry.append(f"```c\n{declaration.text}\n```\n")
    return [*entry, "````\n"]


# ---- C++ -------------------------------------------------------------------------------------------------------------


def cpp_items(header: str) -> Iterator[tuple[str, str]]:
    """(comment, declaration) of what stands in namespace arm3r or one within it, function bodies left out."""
    inside = re.split(r"^namespace arm3r(?:::\w+)? \{\n", header, maxsplit=1, flags=re.M)[-1]
    inside = inside.rpartition("}  // namespace arm3r")[0]
    comment: list[str] = []
    item: list[str] = []
    for line in inside.splitlines():
        if not item and line.startswith("//"):
            comment.append(line.removeprefix("//").strip())
        elif not item and (not line.strip() or line.startswith("#")):
            comment = []
        else:
            item.append(line)
            if is_complete("\n".join(item)):
                yield " ".join(comment), shortened("\n".join(item))
                comment, item = [], []


def is_complete(text: str) -> bool:
    code = re.sub(r"//.*", "", text).rstrip()
    return code.count("{") == code.count("}") and code.count("(") == code.count(")") and code.endswith((";", "}"))


def shortened(item: str) -> str:
    """What a user of the header needs to see: no bodies of functions, no private members."""
    text = re.sub(r"\bARM3R_INLINE(_LAMBDA)? ", "", item)
    text = re.sub(r"\nprivate:.*(?=\n\};$)", "", text, flags=re.S)
    out, at = "", 0
    while body := re.compile(r"(?<=[)])((?: const| noexcept| requires [^{]*| : [^{]*)*) ?\{").search(text, at):
        out += text[at : body.start()] + body[1].split(" : ")[0] + ";"
        at = end_of_block(text, body.end())
    return re.sub(r"\n {20,}", "\n    ", out + text[at:])


def end_of_block(text: str, at: int) -> int:
    """The place behind the brace that closes the block in which `at` stands."""
    depth = 1
    while depth:
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        at += 1
    return at


def cpp_page(room: str) -> str:
    """The reference of a folder of templates: its README, then each header."""
    folder = TEMPLATES / room
    lines = [(folder / "README.md").read_text()]
    for path in sorted(folder.glob("*.hpp")):
        text = path.read_text()
        about = re.search(r"^((?://.*\n)+)", text, re.M)
        assert about, path
        lines += [f"## {path.name}\n", escaped(" ".join(re.findall(r"// ?(.*)", about[1]))) + "\n"]
        for comment, item in cpp_items(text):
            lines += [escaped(comment) + "\n"] if comment else []
            lines.append(f"```cpp\n{item}\n```\n")
    return "\n".join(lines)


def written(out: Path) -> None:
    """Write c.md and cpp_*.md into the folder `out`."""
    out.mkdir(parents=True, exist_ok=True)
    (out / "c.md").write_text(c_page(HEADER.read_text()))
    for room in ROOMS:
        (out / f"cpp_{room}.md").write_text(cpp_page(room))
