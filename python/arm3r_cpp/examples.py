"""The scenarios and sweeps that are installed with the package: their names, what they show, their text."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from ._files import folder_named, writing
from ._messages import did_you_mean
from .errors import OutputError, UsageError

DATA = Path(__file__).parent / "share" / "arm3r"
FOLDER = (DATA / "scenarios").resolve()
_SCHEMA_LINE = re.compile(r"^# yaml-language-server: \$schema=(.*)$", re.MULTILINE)


@cache
def names() -> list[str]:
    """Every example by its path without ".yaml", such as "moving_wall" or "lecture/05_free_fall"; sweeps come last."""
    found = [path.relative_to(FOLDER).with_suffix("").as_posix() for path in FOLDER.rglob("*.yaml")]
    return sorted(found, key=lambda name: (is_sweep(name), name.count("/"), name))


def is_sweep(name: str) -> bool:
    return name.startswith("sweeps/")


def path_of(name: str) -> Path:
    """The file of an example. The name of its folder may be left out, and ".yaml" may stand at its end.

    Raises:
        UsageError: there is no such example; the message names the nearest one.
    """
    wanted = name.removesuffix(".yaml")
    found = [known for known in names() if wanted in (known, known.rpartition("/")[2])]
    if len(found) != 1:
        short = {known.rpartition("/")[2]: known for known in names()}
        hint = did_you_mean(wanted, [*names(), *short]) or "`arm3r examples` lists them"
        raise UsageError(f"{name}: there is no example of this name; {hint}", code="usage")
    return FOLDER / f"{found[0]}.yaml"


def text_of(path: Path) -> str:
    """The text of an example for a place elsewhere: its first line names the installed schema."""
    return _SCHEMA_LINE.sub(lambda line: f"# yaml-language-server: $schema={(path.parent / line[1]).resolve()}",
                            path.read_text(), count=1)  # fmt: skip


def summary(path: Path) -> str:
    """What an example shows: the first sentence of the comment at its head."""
    head = []
    for line in path.read_text().splitlines():
        if not line.startswith("#"):
            break
        if not _SCHEMA_LINE.match(line):
            head.append(line.lstrip("# "))
    return re.split(r"(?<=[^.][.?!])\s", " ".join(head), maxsplit=1)[0]


def copy(paths: list[Path], folder: Path) -> list[Path]:
    """Copy examples into a folder, in which they lie as they do in the package, each sweep with its scenario.

    Raises:
        UsageError: the folder has the name of a file.
        OutputError: one of the files exists already, or cannot be written.
    """
    folder = folder_named(folder)
    files = {folder / path.relative_to(FOLDER): path for path in _with_scenarios(paths)}
    for target in files:
        if target.exists():
            raise OutputError(f"{target}: exists already; name another folder, or remove it", code="output")
    for target, path in files.items():
        with writing(target):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text_of(path))
    return list(files)


def _with_scenarios(paths: list[Path]) -> list[Path]:
    """The same, and before each sweep the scenario that it names."""
    found = []
    for path in paths:
        named = re.search(r"^scenario: (\S+)", path.read_text(), re.MULTILINE)
        found += [(path.parent / named[1]).resolve(), path] if named else [path]
    return list(dict.fromkeys(path.resolve() for path in found))
