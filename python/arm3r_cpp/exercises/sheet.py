"""The tasks on paper: A4 pages with fields for name and date, the points of each task, and page numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .._messages import shown
from .feedback import hand_in, whose
from .numbers import Numbers
from .task import Task

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.font_manager import FontProperties

WIDTH, HEIGHT, MARGIN = 595.3, 841.9, 62.0  # A4, in points of 1/72 inch
TOP, BOTTOM = HEIGHT - 92.0, 62.0  # of the text; above stand the fields, below the page's number
LEADING = 1.38  # of a line, in sizes of its font
INDENT = 10.0  # of a listing
SERIF, BOLD, MONO = "STIXGeneral", "STIXGeneral:bold", "DejaVu Sans Mono"
SIZE, CODE_SIZE, TITLE_SIZE = 10.5, 8.0, 17.0


class Fragment(NamedTuple):
    """Text in one font."""

    text: str
    font: str
    size: float

    @property
    def width(self) -> float:
        return self.size * sum(advance(letter, self.font) for letter in self.text)


@dataclass(frozen=True)
class Line:
    """What stands on one line, each from its place on, and the height of the line."""

    fragments: tuple[tuple[float, Fragment], ...]
    height: float
    is_shaded: bool = False


def write_sheet(path: Path, tasks: Sequence[Task], numbers: Numbers) -> int:
    """Write the sheet as PDF, the same bytes each time; how many pages it has."""
    import matplotlib
    from matplotlib.backends.backend_pdf import PdfPages

    with matplotlib.rc_context({**matplotlib.rcParamsDefault, "pdf.fonttype": 42}):
        figures = pages(tasks, numbers)
        with PdfPages(path, metadata={"Title": "arm3r exercises", "CreationDate": None}) as pdf:
            for figure in figures:
                pdf.savefig(figure)
    return len(figures)


def pages(tasks: Sequence[Task], numbers: Numbers) -> list[Figure]:
    """The pages as figures."""
    blocks = [head(tasks), *(lines_of(number, task) for number, task in enumerate(tasks, start=1))]
    filled = broken(blocks)
    return [
        page(lines, numbers, f"page {number} of {len(filled)}{', ' + whose(numbers) if numbers.student else ''}")
        for number, lines in enumerate(filled, start=1)
    ]


def broken(blocks: Sequence[Sequence[Line]]) -> list[list[Line]]:
    """The lines of each page; a block stands on one page if it fits on one."""
    filled: list[list[Line]] = [[]]
    room = TOP - BOTTOM
    for block in blocks:
        if height_of(block) > room - height_of(filled[-1]):
            filled.append([])
        for line in block:
            if line.height > room - height_of(filled[-1]):
                filled.append([])
            filled[-1].append(line)
    return filled


def height_of(lines: Sequence[Line]) -> float:
    return sum(line.height for line in lines)


# ---- lines ----------------------------------------------------------------------------------------------------------


def head(tasks: Sequence[Task]) -> list[Line]:
    points = sum(task.points for task in tasks)
    title = Fragment("Exercises about the lecture's arm", BOLD, TITLE_SIZE)
    total = Fragment(f"____ of {points} points", SERIF, SIZE)
    return [line_of(title, at_right=total), gap(14)]


def lines_of(number: int, task: Task) -> list[Line]:
    """The task as it is set: its head, its text, what is given, and what is due."""
    title = Fragment(f"{number}.  {capital(task.title)}", BOLD, SIZE + 1.5)
    lines = [line_of(title, at_right=Fragment(f"____ of {task.points} points", SERIF, SIZE)), gap(3)]
    for paragraph in task.text.strip("\n").split("\n\n"):
        lines += [*(listing(paragraph) if paragraph.startswith("    ") else wrapped(paragraph)), gap(5)]
    if task.given:
        lines += [
            *wrapped(f"Given, `{task.name}{task.given_suffix}`:"),
            gap(4),
            *listing(task.given, is_shaded=True),
            gap(5),
        ]
    return [*lines, *wrapped(hand_in(task)), gap(20)]


def capital(title: str) -> str:
    return title[0].upper() + title[1:]


def gap(height: float) -> Line:
    return Line((), height)


def line_of(text: Fragment, *, at_right: Fragment) -> Line:
    return Line(((MARGIN, text), (WIDTH - MARGIN - at_right.width, at_right)), text.size * LEADING)


def wrapped(paragraph: str) -> Iterator[Line]:
    """The words of a paragraph, in as many lines as they need; what stands in backticks is code."""
    line: list[Fragment] = []
    for word in words_of(paragraph):
        longer = joined([*line, Fragment(" ", SERIF, SIZE), *word]) if line else word
        if line and width_of(longer) > WIDTH - 2 * MARGIN:
            yield placed(line)
            longer = word
        line = longer
    yield placed(line)


def words_of(paragraph: str) -> list[list[Fragment]]:
    """Each word as the fragments that stand together: code, and what follows it without a space."""
    words: list[list[Fragment]] = [[]]
    for number, part in enumerate(paragraph.replace("\n", " ").split("`")):
        font, size = (MONO, CODE_SIZE + 1) if number % 2 else (SERIF, SIZE)
        for place, text in enumerate(part.split(" ")):
            if place:
                words.append([])
            if text:
                words[-1].append(Fragment(text, font, size))
    return [word for word in words if word]


def joined(fragments: Sequence[Fragment]) -> list[Fragment]:
    """Neighbours of one font as one."""
    return [
        Fragment("".join(one.text for one in same), font, size)
        for (font, size), same in groupby(fragments, key=lambda one: (one.font, one.size))
    ]


def width_of(fragments: Sequence[Fragment]) -> float:
    return sum(fragment.width for fragment in fragments)


def placed(fragments: Sequence[Fragment]) -> Line:
    """A line of text, from the left margin on."""
    places = [MARGIN + width_of(fragments[:number]) for number in range(len(fragments))]
    return Line(tuple(zip(places, fragments, strict=True)), SIZE * LEADING)


def listing(text: str, *, is_shaded: bool = False) -> list[Line]:
    """Lines of code as they stand, smaller if one is too long."""
    texts = text.strip("\n").split("\n")
    widest = max(Fragment(one, MONO, CODE_SIZE).width for one in texts)
    size = CODE_SIZE * min(1.0, (WIDTH - 2 * MARGIN - 2 * INDENT) / widest)
    return [Line(((MARGIN + INDENT, Fragment(one, MONO, size)),), size * LEADING, is_shaded) for one in texts]


# ---- pages ----------------------------------------------------------------------------------------------------------


def page(lines: Sequence[Line], numbers: Numbers, foot: str) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH / 72, HEIGHT / 72))
    draw_fields(figure, numbers)
    draw(figure, Fragment(foot, SERIF, SIZE - 1.5), MARGIN, BOTTOM - 26)
    y = TOP
    for is_shaded, together in groupby(lines, key=lambda line: line.is_shaded):
        block = list(together)
        if is_shaded:
            shade(figure, y - height_of(block), height_of(block))
        for line in block:
            for x, fragment in line.fragments:
                draw(figure, fragment, x, y - 0.75 * line.height)
            y -= line.height
    return figure


def draw_fields(figure: Figure, numbers: Numbers) -> None:
    """Name and date, to be written by hand where they are not known."""
    name = Fragment(shown(numbers.student), SERIF, SIZE)
    y, date = HEIGHT - 56, WIDTH - MARGIN - 130
    draw(figure, Fragment("Name", SERIF, SIZE), MARGIN, y)
    draw(figure, Fragment("Date", SERIF, SIZE), date, y)
    rule(figure, MARGIN + 32, date - 20, y - 2)
    rule(figure, date + 28, WIDTH - MARGIN, y - 2)
    if can_be_set(name) and name.width < date - MARGIN - 56:
        draw(figure, name, MARGIN + 36, y)


def can_be_set(fragment: Fragment) -> bool:
    """Whether the font has all its letters."""
    file = file_of(fragment.font)
    return all(file.get_char_index(ord(letter)) for letter in fragment.text)


def draw(figure: Figure, fragment: Fragment, x: float, y: float) -> None:
    font = properties(fragment.font, fragment.size)
    figure.text(x / WIDTH, y / HEIGHT, fragment.text, fontproperties=font, parse_math=False)


def rule(figure: Figure, left: float, right: float, y: float) -> None:
    from matplotlib.lines import Line2D

    figure.add_artist(Line2D([left / WIDTH, right / WIDTH], [y / HEIGHT] * 2, color="black", linewidth=0.5))


def shade(figure: Figure, y: float, height: float) -> None:
    from matplotlib.patches import Rectangle

    place: Any = (MARGIN / WIDTH, y / HEIGHT)
    figure.add_artist(Rectangle(place, 1 - 2 * MARGIN / WIDTH, height / HEIGHT, color="#f0f0f0", linewidth=0))


# ---- fonts ----------------------------------------------------------------------------------------------------------


def properties(font: str, size: float) -> FontProperties:
    from matplotlib.font_manager import FontProperties

    family, _, weight = font.partition(":")
    return FontProperties(family=family, weight=weight or "normal", size=size)


@cache
def file_of(font: str) -> Any:
    from matplotlib.font_manager import findfont, get_font

    return get_font(findfont(properties(font, SIZE)))


@cache
def advance(letter: str, font: str) -> float:
    """From a letter to the next one, in sizes of the font."""
    file = file_of(font)
    file.set_size(100, 72)
    advance: float = file.load_char(ord(letter)).linearHoriAdvance / 65536 / 100
    return advance
