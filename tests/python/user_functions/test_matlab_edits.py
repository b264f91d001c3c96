"""An edit of a MATLAB file gives what the edited file gives, although few of its statements are evaluated again."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from arm3r_cpp.user_functions.expressions import Number
from arm3r_cpp.user_functions.matlab.program import MatlabProgram
from arm3r_cpp.user_functions.programs import Call, Edit, ProgramError
from arm3r_cpp.verify.explain.edits import Editor
from formulas.outcomes import FILES
from numpy.typing import NDArray
from random_scenarios import sample_seed

Floats = NDArray[np.float64]
_TEXTS = {
    "fields": "function y = f(q)\np.a = q(1); p.b = 2; r = p; r.a = 3; y = [p.a; r.a + r.b; q(2)];\nend\n",
    "parts": "function y = f(q)\ny = zeros(3, 1); y(1) = q(1); y(2) = 2*y(1); y(3) = y(2) + q(3);\nend\n",
    "loop": "function y = f(q)\ny = [0; 0; 0];\n"
    "for k = 1:3\nif k > 1, y(k) = y(k-1) + q(k); end\nend\nz = k; y = z*y;\nend\n",
    "leaves": "function y = f(q)\ny = q(1);\nif 1 > 2, y = 0; return, end\ny = y + 1;\nend\n",
    "handle": "function y = f(q)\na = 2; g = @(x) a*x; a = 3; y = g(q(1)) + a;\nend\n",
    "calls": "function y = f(q)\nc = g(q(1)); y = c + h(q(2));\nend\nfunction y = g(x)\ny = 2*x;\nend\n"
    "function y = h(x)\ny = g(x) + 1;\nend\n",
    "itself": "function y = f(q)\nif numel(q) < 2, y = 2*q; else, y = f(q(1)) + 3; end\ny = y + 1;\nend\n",
    "stays": "function y = f(q)\npersistent n\nif isempty(n), n = 0; end\nn = n + 1; y = n*q(1);\nend\n",
    "name": "function y = f(q)\nx = 1; if exist('x'), y = x + q(1); else, y = 0; end\nend\n",
    "divided": "function y = f(q)\na = 2;\nif q(1) > 0, y = a; else, y = 3*a; end\nend\n",
}


def value_of(text: str, table: Floats, name: str) -> Floats | str:
    try:
        return evaluated(MatlabProgram(text, name), table)
    except Exception as error:
        return type(error).__name__


def evaluated(program: MatlabProgram, table: Floats, edit: Edit | None = None) -> Floats | str:
    count = len(program.arguments)
    slots = tuple(range(count)) if count > 3 else tuple((0, 1, 2) for _ in range(count))
    try:
        return program.evaluate(Call(slots, {}), table, edit)
    except ProgramError:
        return "ProgramError"


def edits_of(program: MatlabProgram) -> list[Edit]:
    nodes = program.nodes()
    editor = Editor(program.text, nodes, "matlab", program.arguments, [], program.outputs)
    numbers = [one for node in nodes for one in node.walk() if isinstance(one, Number)]
    return [*editor.all(nodes), *(Edit(one.start, one.end, "7") for one in numbers)]


def hold(name: str, text: str, count: int, chance: random.Random) -> None:
    program = MatlabProgram(text, name)
    tables = np.random.default_rng(chance.randrange(1 << 30)).uniform(-2, 2, (2, 3, 12))
    edits = edits_of(program)
    for edit in chance.sample(edits, min(count, len(edits))):
        table = chance.choice(tables)
        found, due = evaluated(program, table, edit), value_of(edit.apply(text), table, name)
        if isinstance(found, str) or isinstance(due, str):
            assert isinstance(found, str) and isinstance(due, str), (name, edit, found, due)
        else:
            assert np.array_equal(found, due, equal_nan=True), (name, edit)


@pytest.mark.parametrize("name", _TEXTS)
def test_an_edit_gives_what_the_edited_text_gives(name: str) -> None:
    hold(name, _TEXTS[name], 400, random.Random(sample_seed()))


@pytest.mark.sample(12)
@pytest.mark.parametrize("path", [one for one in FILES if one.suffix == ".m"], ids=lambda one: one.stem)
def test_an_edit_of_a_students_file_gives_what_the_edited_file_gives(path: Path) -> None:
    hold(path.name, path.read_text(), 60, random.Random(sample_seed()))


def test_most_statements_are_not_evaluated_again(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = [f"a{number} = q(1)*{number};" for number in range(1, 40)]
    text = "\n".join(["function y = f(q)", *lines, "y = a7 + a8;", "end", ""])
    program = MatlabProgram(text, "many.m")
    executed: list[object] = []
    execute = MatlabProgram._assign
    monkeypatch.setattr(
        MatlabProgram, "_assign", lambda self, one, *rest: executed.append(one) or execute(self, one, *rest)
    )
    place = text.index("q(1)*7")
    edit, table = Edit(place, place + 4, "q(2)"), np.array([[0.5, 0.25, 0.125]])
    assert evaluated(program, table) == pytest.approx(7.5)
    assert evaluated(program, table, edit) == pytest.approx(0.25 * 7 + 0.5 * 8)
    executed.clear()
    assert evaluated(program, table, edit) == pytest.approx(0.25 * 7 + 0.5 * 8)
    assert len(executed) == 2
