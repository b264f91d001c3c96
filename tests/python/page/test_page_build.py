"""`make page`: a change of JavaScript alone needs neither a compiler nor the package index."""

from __future__ import annotations

import shutil
import subprocess

import pytest
from conftest import ROOT

BUILT = ["build/page/arm3r.wasm", "build/page/core_licenses.txt", "web/page/node_modules/.package-lock.json"]


@pytest.mark.skipif(shutil.which("make") is None, reason="there is no make")
def test_after_a_change_of_javascript_make_page_only_bundles() -> None:
    """What was built counts as built; main.js and the page that is installed with the package as new."""
    old = [word for file in BUILT for word in ("--old-file", file)]
    new = ["--what-if", "web/page/src/main.js", "--what-if", "build/page/live.html"]
    command = ["make", "--dry-run", "--no-print-directory", *old, *new, "page"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["node web/page/build.mjs"]
