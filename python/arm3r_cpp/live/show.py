"""The page in a notebook, in a browser, or in a file of its own."""

from __future__ import annotations

import os
import tempfile
import webbrowser
from html import escape
from pathlib import Path

from .._files import check_ending, check_folder, replacing
from ..core.run import Run
from ..core.scenario import Scenario
from ..errors import UsageError
from . import page, page_data

HEIGHT = 760  # px of a notebook's cell


def show(run_or_scenario: Run | Scenario, *, height: int = HEIGHT) -> None:
    """Show a run as it is, or a scenario that the page simulates: in a notebook's cell, else in a browser.

    The page can be worked with: whatever is changed in it is simulated there, and does not come back to Python.

    Args:
        run_or_scenario: a run, finished or partial, or a scenario.
        height: of the cell, px.

    Raises:
        UsageError: it is neither, the installation has no page, or there is no browser.
    """
    from ..plot.run_figure import has_notebook

    html = page.html("live.html", _data(run_or_scenario))
    if has_notebook():
        from IPython import display

        display.display(Cell(html, height))
    else:
        _open_in_browser(html)


class Cell:
    """The page as a notebook shows it: in a frame of its own."""

    def __init__(self, html: str, height: int) -> None:
        self._html, self._height = html, height

    def _repr_html_(self) -> str:
        look = f"width: 100%; height: {self._height:d}px; border: 1px solid #ccc; border-radius: 8px"
        return f'<iframe title="arm3r live" style="{look}" srcdoc="{escape(self._html)}"></iframe>'


def write(run: Run, path: str | os.PathLike[str]) -> None:
    """One file with the page and the run, which opens from disk; whole or not at all.

    Raises:
        OutputError: it cannot be written.
        UsageError: another ending than .html, no page in the installation, or no scenario in the run's summary.
    """
    check_ending(path, [".html"], hint="to_csv writes .csv, to_npz .npz")
    target = Path(path)
    html = page.html("live.html", page_data.of_run(run))
    check_folder(target.parent)
    with replacing(target) as part:
        part.write_text(html, encoding="utf-8", newline="\n")


def _data(run_or_scenario: Run | Scenario) -> dict[str, object]:
    if isinstance(run_or_scenario, Run):
        return page_data.of_run(run_or_scenario)
    if isinstance(run_or_scenario, Scenario):
        return page_data.of_text(run_or_scenario.to_yaml(), run_or_scenario.name)
    got = type(run_or_scenario).__name__
    raise UsageError(f"show: a run or a scenario is needed, such as show(scenario.run()), got {got}", code="usage")


def _open_in_browser(html: str) -> None:
    """From a file in the folder for temporary files: a browser reads it when this process may have ended."""
    with tempfile.NamedTemporaryFile("w", suffix=".html", prefix="arm3r-", delete=False, encoding="utf-8") as file:
        file.write(html)
    if not webbrowser.open(Path(file.name).as_uri()):
        raise UsageError(f"show: there is no browser here; the page is in {file.name}", code="usage")
