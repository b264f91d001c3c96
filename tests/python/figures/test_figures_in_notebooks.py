"""Figures in a notebook: each cell shows exactly the pictures that it should, and pyplot is the user's own."""

from __future__ import annotations

from typing import Any

import nbclient
import nbformat
import pytest

RUN = """import arm3r_cpp as arm3r
run = arm3r.Scenario("{format: 1, name: fall, time: {stop: 0.1, log_every: 0.01}}").run()"""
PLAIN = [
    (RUN, 0),
    ("arm3r.plot.overview(run, panels=['tip'])", 1),
    ("figure = arm3r.plot.overview(run, panels=['tip'])", 0),
    ("figure", 1),
    ("arm3r.plot.show(figure)", 1),
    ("arm3r.plot.show(figure, *arm3r.plot.lecture(run, panels=['tip', 'torques']).values())", 3),
]
PYPLOT = [
    (RUN, 0),
    ("arm3r.plot.overview(run, panels=['tip'])", 1),
    ("import matplotlib.pyplot as plt\nplt.plot([0, 1], [0, 1]);", 1),
    ("arm3r.plot.overview(run, panels=['tip'])", 1),
    ("plt.plot([0, 1], [1, 0])\nlen(plt.gcf().axes), len(plt.gca().lines)", 1),
    ("figure = arm3r.plot.overview(run, panels=['tip'])\nplt.plot([0, 1]);", 1),
    ("arm3r.plot.overview(run, panels=['tip'])\nplt.show()", 0),
    ("plt.plot([0, 1])\narm3r.plot.show(figure)", 2),
    ("plt.get_fignums()", 0),
]


def pictures(cells: list[tuple[str, int]]) -> tuple[list[int], list[str]]:
    """How many pictures the cells of a notebook show, and the text of each one's value."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code) for code, _ in cells])
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    data = [[output.get("data", {}) for output in cell.outputs] for cell in notebook.cells]
    values = ["".join(part.get("text/plain", "") for part in outputs if "image/png" not in part) for outputs in data]
    return [sum("image/png" in part for part in outputs) for outputs in data], values


@pytest.mark.sample(1)
@pytest.mark.parametrize("cells", [PLAIN, PYPLOT], ids=["without pyplot", "with pyplot"])
def test_each_cell_shows_its_figures_once(cells: Any) -> None:
    counts, values = pictures(cells)
    assert counts == [wanted for _, wanted in cells]
    if cells is PYPLOT:
        assert values[4] == "(1, 1)"  # the user's axes hold the user's line alone
        assert values[-1] == "[]"
