"""What the documents say is what the program does."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from conftest import script


@pytest.mark.parametrize(
    "page, call",
    [
        ("scenario.md", ["schema", "--format", "md"]),
        ("columns.md", ["columns", "--format", "md"]),
        ("scenario.schema.json", ["schema"]),
        ("sweep.schema.json", ["sweep", "--schema"]),
    ],
)
def test_generated_pages_are_what_the_program_prints(
    root: Path, cli, scripts: Path, page: str, call: list[str]
) -> None:
    environment = {**os.environ, "PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}
    printed = cli(*call, env=environment).stdout
    assert (root / "docs" / page).read_text() == printed, f"arm3r {' '.join(call)} > docs/{page}"


def test_every_equation_the_code_cites_is_in_the_model(root: Path) -> None:
    sources = [path for path in (root / "cpp").rglob("*") if path.suffix in (".hpp", ".cpp")]
    comments = [comment for path in sources for comment in re.findall(r"//.*", path.read_text())]
    cited = {number for comment in comments for number in re.findall(r"\((\d\.\d+)\)", comment)}
    numbered = set(re.findall(r"\((\d\.\d+)\)", (root / "docs/model.md").read_text()))
    assert len(cited) > 20
    assert cited <= numbered


def test_every_link_between_pages_leads_somewhere(root: Path) -> None:
    for page in [*root.glob("*.md"), *root.glob("docs/*.md")]:
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


def test_the_readme_leads_to_every_page(root: Path) -> None:
    readme = (root / "README.md").read_text()
    assert [page.name for page in root.glob("docs/*.md") if f"(docs/{page.name})" not in readme] == []


FIGURES_OF_SPEECH = re.compile(
    r"\bbooks\b|arm3r CALL|\bleaves? over\b|so-manieth|\blets? go\b|\bbears\b|\bdent(ed)?\b|slip of typing|"
    r"shall believe|\b[Ww]hoever\b|\bheld against\b|\bof one's own\b|\b[Nn]obody\b|\btold apart\b|bats it"
)


def test_texts_use_the_words_of_the_field(root: Path) -> None:
    """Pages, messages, help and comments: no figure of speech that was found once and replaced."""
    found = []
    for folder in ("docs", "python", "cpp", "scenarios", "benchmarks", "tests"):
        for path in (root / folder).rglob("*"):
            if path.suffix in (".md", ".py", ".hpp", ".cpp", ".h", ".c", ".yaml") and path != Path(__file__):
                for number, line in enumerate(path.read_text().splitlines(), 1):
                    found += [f"{path.relative_to(root)}:{number}: {m[0]}" for m in FIGURES_OF_SPEECH.finditer(line)]
    for path in root.glob("*.md"):
        if path.name != "CHANGELOG.md":
            found += [f"{path.name}: {m[0]}" for m in FIGURES_OF_SPEECH.finditer(path.read_text())]
    assert found == []


def test_prose_is_wrapped(root: Path) -> None:
    """`python tools/wrap_markdown.py FILE...` wraps it."""
    wrap_markdown = script("tools/wrap_markdown.py")
    pages = [*root.glob("*.md"), *root.glob("docs/*.md"), *root.glob("cpp/**/*.md")]
    found = {page.name: wrap_markdown.too_long(page.read_text()) for page in pages if page.name != "CHANGELOG.md"}
    assert {name: lines for name, lines in found.items() if lines} == {}
