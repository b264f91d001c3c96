"""The site: its pages are complete, what is written from sources has all of them, and every link leads somewhere."""

from __future__ import annotations

import base64
import re
import subprocess
import sys
import zlib
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlparse

import arm3r_cpp as arm3r
import pytest
from conftest import ROOT, scenario_files

SITE = ROOT / "docs/site"
sys.path.insert(0, str(SITE))

import badges  # noqa: E402
import gallery  # noqa: E402
import headers  # noqa: E402

HEADER = headers.HEADER.read_text()


# ---- what is written from sources -----------------------------------------------------------------------------------


def test_the_c_reference_has_every_declaration_and_every_comment() -> None:
    page = headers.c_page(HEADER)
    code = re.sub(r"/\*.*?\*/", "", HEADER, flags=re.S)
    functions = set(re.findall(r"^ARM3R_API .*?\b(arm3r_\w+)\(", code, re.M))
    types = set(re.findall(r"^typedef .*?\b(arm3r_\w+)(?:;|\))", code, re.M)) | set(
        re.findall(r"^\} (arm3r_\w+);", code, re.M)
    )
    assert len(functions) > 60 and len(types) > 10
    entries = " ".join(re.findall(r"\{c:\w+\} (.*)", page))
    assert {name for name in functions | types if not re.search(rf"\b{name}\b", entries)} == set()
    text = re.sub(r"[\\\s]+", "", page)
    comments = [headers.words(comment) for comment in re.findall(r"/\*.*?\*/", HEADER, re.S)]
    for comment in comments:
        if "----" not in comment and "Nullable" not in comment and "mass matrix" not in comment:
            assert re.sub(r"[\\\s]+", "", comment) in text, comment


def test_the_cpp_reference_has_every_function() -> None:
    for room in headers.ROOMS:
        page = headers.cpp_page(room)
        assert "{{" not in page and "private:" not in page
        for path in (headers.TEMPLATES / room).glob("*.hpp"):
            assert f"## {path.name}\n" in page
            for name in re.findall(r"^ARM3R_INLINE .*?(\w+)\(", path.read_text(), re.M):
                assert re.search(rf"\b{name}\(", page), f"{path.name}: {name}"


def test_bodies_of_functions_are_left_out() -> None:
    code = (
        "template <class T>\nARM3R_INLINE T twice(const T& x) {  // 2x\n    if (x) { return x + x; }\n    return x;\n}"
    )
    assert headers.shortened(code) == "template <class T>\nT twice(const T& x);"
    struct = "struct Two {\n    int a = 1;  // m\n    int sum() const { return a; }\nprivate:\n    int b;\n};"
    assert headers.shortened(struct) == "struct Two {\n    int a = 1;  // m\n    int sum() const;\n};"


def test_the_python_reference_has_every_public_name() -> None:
    page = (SITE / "pages/reference/python.md").read_text()
    public = [name for name in dir(arm3r) if not name.startswith("_")]
    figures = [f"plot.{name}" for name in dir(arm3r.plot) if not name.startswith("_")]
    assert [name for name in public + figures if f"arm3r_cpp.{name}" not in page] == []


def test_the_gallery_has_every_scenario() -> None:
    page = gallery.page()
    for path in scenario_files():
        assert f"arm3r run {path.relative_to(ROOT)}\n" in page
    assert "live" not in page.partition("## ")[2]


def test_a_link_to_the_live_page_carries_the_scenario() -> None:
    text = (ROOT / "scenarios/moving_wall.yaml").read_text()
    page = gallery.page("live/index.html")
    code = re.search(r'\[moving_wall\].*?href="live/index\.html#s=([\w-]+)">live</a>', page)[1]
    assert zlib.decompress(base64.urlsafe_b64decode(code + "=" * (-len(code) % 4))).decode() == text


def test_every_page_is_in_the_index() -> None:
    index = (SITE / "pages/index.md").read_text()
    trees = re.findall(r"[\w/]+", " ".join(re.findall(r"```\{toctree\}(.*?)```", index, re.S)))
    pages = [path.relative_to(ROOT).with_suffix("").as_posix() for path in ROOT.glob("docs/*.md")]
    pages += [path.relative_to(ROOT).with_suffix("").as_posix() for path in ROOT.glob("docs/notebooks/*.ipynb")]
    assert [page for page in pages if page not in trees] == []


# ---- the project's address ------------------------------------------------------------------------------------------


def test_badges_are_left_out_while_there_is_no_address() -> None:
    assert badges.badges(badges.address({"project": {}}), "docs/notebooks/lecture.ipynb") == ""
    assert badges.badges("https://example.org/arm3r", "docs/notebooks/lecture.ipynb") == ""


@pytest.mark.parametrize("end", ["", "/", ".git"])
def test_badges_follow_from_the_address(end: str) -> None:
    project = {"project": {"urls": {"Repository": f"https://github.com/someone/arm3r.x{end}"}}}
    line = badges.badges(badges.address(project), "docs/notebooks/lecture.ipynb")
    assert "https://colab.research.google.com/github/someone/arm3r.x/blob/main/docs/notebooks/lecture.ipynb" in line
    assert "https://mybinder.org/v2/gh/someone/arm3r.x/HEAD?labpath=docs%2Fnotebooks%2Flecture.ipynb" in line


def test_badges_of_this_project_are_those_of_its_address() -> None:
    repository = badges.address(badges.project())
    assert bool(badges.badges(repository, "x.ipynb")) == repository.startswith("https://github.com/")


# ---- the built site -------------------------------------------------------------------------------------------------


class Page(HTMLParser):
    """The links of a page, the files it loads, its anchors, and its text."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.anchors: set[str] = set()
        self.formulas = 0
        self.feed(path.read_text())

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self.anchors.add(values.get("id", ""))
        self.formulas += tag == "math"
        if tag == "a":
            self.links.append(values.get("href", ""))
        elif tag == "link" and values.get("rel") in ("next", "prev", "index", "search", "author"):
            self.links.append(values["href"])
        else:
            self.loaded += [values[name] for name in ("src", "href", "data") if values.get(name)]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site") / "html"
    done = subprocess.run([sys.executable, SITE / "build.py", folder], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder


def leads_nowhere(site: Path, pages: dict[Path, Page], page: Path, link: str) -> bool:
    """Whether a link inside of the site has no file, or no such place in it."""
    url = urlparse(link)
    if url.scheme in ("http", "https", "mailto", "data") or link in ("", "#"):
        return False
    target = (page.parent / unquote(url.path)).resolve() if url.path else page
    if not target.is_file() or not target.is_relative_to(site):
        return True
    return bool(url.fragment) and target in pages and unquote(url.fragment) not in pages[target].anchors


@pytest.mark.gate
@pytest.mark.needs("site")
def test_every_link_of_the_site_leads_somewhere(site: Path) -> None:
    pages = {path: Page(path) for path in site.rglob("*.html") if "live" not in path.relative_to(site).parts}
    assert len(pages) > 40
    dead = {
        f"{path.relative_to(site)} -> {link}"
        for path, page in pages.items()
        for link in page.links + page.loaded
        if leads_nowhere(site, pages, path, link)
    }
    assert dead == set()
    elsewhere = {link for page in pages.values() for link in page.loaded if urlparse(link).netloc}
    assert elsewhere == set(), "a page loads from another host"


@pytest.mark.gate
@pytest.mark.needs("site")
def test_formulas_search_and_results_are_in_the_site(site: Path) -> None:
    model = site / "docs/model.html"
    assert Page(model).formulas > 300 and "$`" not in model.read_text()
    assert "arm3r_scenario_run" in (site / "searchindex.js").read_text()
    assert "232.05 N" in (site / "docs/notebooks/lecture.html").read_text()
    style = "".join(path.read_text() for path in (site / "_static").rglob("*.css"))
    assert not re.search(r"url\(['\"]?https?:|@import", style), "a style sheet loads from another host"
