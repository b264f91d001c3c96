"""Notebooks and live scripts are read by their cells."""

from __future__ import annotations

import io
import json
import random
import zipfile
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import arm3r_cpp as arm3r
import pytest

PYTHON = [
    "%matplotlib inline\nimport numpy as np\n!pip list\n",
    "m, g = 0.785, 9.80665\n",
    "def gravity(q):\n    t3 = -m*g/2*np.cos(q[1] + q[2])\n    return np.array([0, -1.5*m*g*np.cos(q[1]) + t3, t3])\n",
    "gravity(np.zeros(3))",
]
MATLAB = """q = [0.1 0.2 0.3];
gravity(q)
function G = gravity(q)
m = 0.785; g = 9.80665;
t3 = -m*g/2*cos(q(2) + q(3));
G = [0; -1.5*m*g*cos(q(2)) + t3; t3];
end
"""
W = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"


def notebook(cells: list[str]) -> bytes:
    found: list[dict[str, Any]] = [{"cell_type": "markdown", "source": ["def wrong(q):\n", "return"]}]
    for number, cell in enumerate(cells):  # a text, or a list of lines
        found.append({"cell_type": "code", "source": cell if number % 2 else cell.splitlines(keepends=True)})
    return json.dumps({"cells": found, "nbformat": 4}).encode()


def paragraph(text: str, style: str) -> str:
    return f'<w:p><w:pPr><w:pStyle w:val="{style}"/></w:pPr><w:r><w:t>{escape(text)}</w:t></w:r></w:p>'


def live_script(text: str, before: str = "") -> bytes:
    lines = "".join(paragraph(line, "code") for line in text.splitlines())
    document = (
        f'{before}<w:document xmlns:w="{W}"><w:body>{paragraph("The weight", "heading")}{lines}</w:body></w:document>'
    )
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("matlab/document.xml", document)
    return content.getvalue()


def test_a_notebook_is_judged(tmp_path: Path) -> None:
    path = tmp_path / "work.ipynb"
    path.write_bytes(notebook(PYTHON))
    assert arm3r.verify.gravity(path).ok
    path.write_bytes(notebook([cell.replace("q[1] + q[2]", "q[1] - q[2]") for cell in PYTHON]))
    (finding, *_) = arm3r.verify.gravity(f"{path}:gravity").findings
    assert (finding.old, finding.new) == ("-", "+")


def test_a_live_script_is_judged(tmp_path: Path) -> None:
    path = tmp_path / "work.mlx"
    path.write_bytes(live_script(MATLAB))
    assert arm3r.verify.gravity(path).ok
    path.write_bytes(live_script(MATLAB.replace("q(2) + q(3)", "q(2) - q(3)")))
    findings = arm3r.verify.gravity(path).findings
    assert {(one.line, one.old, one.new) for one in findings} == {(5, "-", "+")}


def test_a_symbolic_live_script_is_judged(tmp_path: Path) -> None:
    path = tmp_path / "derive.mlx"
    path.write_bytes(
        live_script(
            "syms q1 q2 q3 real\na2 = 1; a3 = 1;\n"
            "r = a2*cos(q2) + a3*cos(q2+q3);\n"
            "p = [cos(q1)*r; sin(q1)*r; a2*sin(q2) + a3*sin(q2+q3)];\n"
            "J = simplify(jacobian(p, [q1 q2 q3]))"
        )
    )
    verdict = arm3r.verify.jacobian(path)
    assert verdict.ok
    assert "its variable J" in str(verdict)


BROKEN = {
    "a.ipynb": b"{",
    "b.ipynb": b"[]",
    "c.ipynb": b'{"cells": 3}',
    "d.ipynb": b"[" * 100_000,
    "a.mlx": b"no archive",
    "b.mlx": live_script("x", '<!DOCTYPE x [<!ENTITY a "aaaa">]>'),
    "c.mlx": live_script(MATLAB)[:-30],
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_document_is_one_line(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(BROKEN[name])
    with pytest.raises(arm3r.UsageError, match=r"this is no (Jupyter notebook|live script)"):
        arm3r.verify.gravity(path)


@pytest.mark.parametrize("suffix", [".ipynb", ".mlx"])
def test_changed_bytes_are_no_fault_of_the_reader(suffix: str, tmp_path: Path) -> None:
    """What is left may be right, wrong or refused."""
    seed = random.randrange(10**6)
    print(f"seed {seed}")
    whole, choose = notebook(PYTHON) if suffix == ".ipynb" else live_script(MATLAB), random.Random(seed)
    path = tmp_path / f"gravity{suffix}"
    for _ in range(25):
        content = bytearray(whole)
        for _ in range(choose.randint(1, 4)):
            content[choose.randrange(len(content))] = choose.randrange(256)
        path.write_bytes(content)
        try:
            arm3r.verify.gravity(path)
        except arm3r.Arm3rError as error:
            assert len(str(error).splitlines()) == 1
