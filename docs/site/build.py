"""python docs/site/build.py [FOLDER]: the site, from the pages of the repository, into build/site or FOLDER.

The pages are collected in build/site_source, at the places that they have in the repository, so that the links between
them hold; what is written from headers and scenarios stands beside them."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import badges
import gallery
import headers

ROOT = Path(__file__).parents[2]
SITE = Path(__file__).parent
PAGE = ROOT / "build/page"
COLLECTED = [
    "*.md", "CITATION.cff", "LICENSE", "Makefile", "docs/*.md", "docs/*.json", "docs/*.py", "docs/images/**/*",
    "docs/notebooks/*.ipynb", "scenarios/**/*.yaml", "cpp/**/README.md",
]  # fmt: skip


def collect(source: Path) -> None:
    """All pages, and the files that they link to, into the folder `source`, which is made anew."""
    shutil.rmtree(source, ignore_errors=True)
    for pattern in COLLECTED:
        for path in filter(Path.is_file, ROOT.glob(pattern)):
            copy = source / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)
    shutil.copytree(SITE / "pages", source, dirs_exist_ok=True)
    headers.written(source / "reference")
    (source / "gallery.md").write_text(gallery.page("live/index.html" if PAGE.is_dir() else ""))
    for path in (source / "docs/notebooks").glob("*.ipynb"):
        add_badges(path)


def add_badges(path: Path) -> None:
    notebook = json.loads(path.read_text())
    line = badges.badges(badges.address(badges.project()), f"docs/notebooks/{path.name}")
    if line:
        notebook["cells"][0]["source"][0] += f"\n{line}\n"
        path.write_text(json.dumps(notebook))


def main(out: Path) -> int:
    source = ROOT / "build/site_source"
    collect(source)
    shutil.rmtree(out, ignore_errors=True)
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-q",
        "-W",
        "--keep-going",
        "-c",
        SITE,
        "-d",
        ROOT / "build/site_doctrees",
    ]
    code = subprocess.call([*command, source, out], env={"SOURCE_DATE_EPOCH": "0", "PYTHONHASHSEED": "0", **os.environ})
    if code == 0 and PAGE.is_dir():
        shutil.copytree(PAGE, out / "live")
    return code


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build/site"))
