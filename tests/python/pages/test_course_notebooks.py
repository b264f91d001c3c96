"""The notebooks of docs/notebooks run, print every number that their text states, and are stored without outputs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT, script

NOTEBOOKS = sorted((ROOT / "docs/notebooks").glob("*.ipynb"))
NUMBER_IN_CODE = re.compile(r"`(-?\d[^`]*)`")
QUESTION = re.compile(r"\*\*Question \d")


def is_shown(path: Path) -> str:
    return path.stem


def executed(path: Path) -> Any:
    """The notebook with the outputs of its cells."""
    import nbclient
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    return notebook


def printed(cell: Any) -> str:
    return "".join(output.get("text", "") for output in cell.outputs if output.get("name") == "stdout")


def test_there_are_five_and_each_leads_to_another() -> None:
    assert len(NOTEBOOKS) == 5
    texts = {path.name: path.read_text() for path in NOTEBOOKS}
    linked = {link for text in texts.values() for link in re.findall(r"\]\((\w+\.ipynb)\)", text)}
    assert linked <= set(texts) and len(linked) == 4


@pytest.mark.parametrize("path", NOTEBOOKS, ids=is_shown)
def test_a_notebook_is_stored_without_outputs(path: Path) -> None:
    strip_notebooks = script("tools/strip_notebooks.py")
    assert path.read_text() == strip_notebooks.stripped(path.read_text()), f"python tools/strip_notebooks.py {path}"


@pytest.mark.sample(1)
@pytest.mark.needs("notebooks")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=is_shown)
def test_a_notebook_runs_and_prints_what_its_text_says(path: Path) -> None:
    cells = executed(path).cells
    so_far = ""
    for cell, following in zip(cells, [*cells[1:], None], strict=True):
        if cell.cell_type == "code":
            assert not [output for output in cell.outputs if output.get("name") == "stderr"], cell.source
            assert "plt.show()" not in cell.source or "image/png" in str(cell.outputs), cell.source
            so_far += printed(cell)
            continue
        for number in NUMBER_IN_CODE.findall(cell.source):
            assert number in so_far, f"the text says {number}, which no cell above it prints:\n{so_far}"
        if QUESTION.search(cell.source.rpartition("\n\n")[2]):
            assert following.cell_type == "code", f"no answer follows:\n{cell.source}"
    assert sum(len(QUESTION.findall(cell.source)) for cell in cells) >= 5
