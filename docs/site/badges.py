"""Links that open a notebook in a browser, from the one address of the project in pyproject.toml."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    from pip._vendor import tomli as tomllib

ROOT = Path(__file__).parents[2]


def address(project: dict[str, Any]) -> str:
    """`Repository` of [project.urls]; empty while it is not set."""
    return str(project["project"].get("urls", {}).get("Repository", ""))


def project() -> dict[str, Any]:
    """pyproject.toml."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text())


def badges(repository: str, notebook: str) -> str:
    """A line of Markdown for the notebook, a path in the repository; empty where GitHub does not have the project."""
    if not (found := re.fullmatch(r"https://github\.com/([\w.-]+/[\w.-]+?)(?:\.git)?/?", repository)):
        return ""
    colab = f"https://colab.research.google.com/github/{found[1]}/blob/main/{notebook}"
    binder = f"https://mybinder.org/v2/gh/{found[1]}/HEAD?labpath={notebook.replace('/', '%2F')}"
    return f"[Open in Colab]({colab}) · [Open in Binder]({binder})"
