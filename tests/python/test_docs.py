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
    ],
)
def test_generated_pages_are_what_the_program_prints(root: Path, cli, page: str, call: list[str]) -> None:
    assert (root / "docs" / page).read_text() == cli(*call).stdout, f"arm3r {' '.join(call)} > docs/{page}"


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


@pytest.fixture
def beside_the_scenarios(root: Path, tmp_path: Path) -> Path:
    (tmp_path / "scenarios").symlink_to(root / "scenarios")
    return tmp_path


def test_the_readmes_python_prints_what_it_says(root: Path, beside_the_scenarios: Path) -> None:
    code = _block(root, "python", "Python")
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=beside_the_scenarios, capture_output=True, text=True, check=True
    )
    promised = re.findall(r"print\(.*\)\s+# (.*)", code)
    assert promised
    for line in promised:
        assert line in done.stdout
    assert (beside_the_scenarios / "overview.png").stat().st_size > 10_000


def test_the_readmes_shell_lines_run(root: Path, beside_the_scenarios: Path, scripts: Path) -> None:
    lines = _block(root, "sh", "Shell")
    done = subprocess.run(
        ["bash", "-ec", lines],
        cwd=beside_the_scenarios,
        capture_output=True,
        text=True,
        env={**os.environ, "PATH": f"{scripts}:{os.environ['PATH']}"},
    )
    assert done.returncode == 0, done.stderr
    assert "FAIL" not in done.stdout
    assert list((beside_the_scenarios / "figures").glob("*.png"))
