"""What the documents say is what the program does."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest


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


def _block(root: Path, language: str, section: str) -> str:
    text = (root / "README.md").read_text().split(f"\n## {section}\n")[1]
    return text.split(f"```{language}\n")[1].split("```")[0]


def test_the_readmes_python_prints_what_it_says(root: Path, tmp_path: Path) -> None:
    """In an empty folder: the installed package has all that it reads."""
    code = _block(root, "python", "Python")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    promised = re.findall(r"print\(.*\)\s+# (.*)", code)
    assert promised
    for line in promised:
        assert line in done.stdout
    assert (tmp_path / "overview.png").stat().st_size > 10_000


def test_the_readmes_shell_lines_run(root: Path, tmp_path: Path, scripts: Path) -> None:
    """In an empty folder, into which the line above the block copies the scenarios."""
    assert "`arm3r examples --copy scenarios`" in (root / "README.md").read_text()
    lines = "arm3r examples --copy scenarios > /dev/null\n" + _block(root, "sh", "Shell")
    done = subprocess.run(
        ["bash", "-ec", lines],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env={**os.environ, "PATH": f"{scripts}:{os.environ['PATH']}"},
    )
    assert done.returncode == 0, done.stderr
    assert "FAIL" not in done.stdout
    assert list((tmp_path / "figures").glob("*.png"))
