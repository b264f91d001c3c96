"""MATLAB as it is written: right programs in every idiom are right, and functions have the values of their formulas."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.user_functions.matlab.functions import FUNCTIONS
from arm3r_cpp.user_functions.matlab.program import MatlabProgram
from arm3r_cpp.user_functions.programs import ProgramError, Unread

IDIOMS = {path.stem: path.read_text() for path in sorted((Path(__file__).parents[1] / "formulas/idioms").glob("*.m"))}
PLAIN = IDIOMS["no_ends"].partition("function y")[0]


@pytest.mark.sample(15)
@pytest.mark.parametrize("name", IDIOMS)
def test_a_right_program_is_right(name: str, tmp_path: Path) -> None:
    text = IDIOMS[name]
    stem = next(one for one in ("gravity", "jacobian", "tip") if f"= {one}(" in text)
    path = tmp_path / f"{stem}.m"
    path.write_text(text)
    judge = {"gravity": arm3r.verify.gravity, "jacobian": arm3r.verify.jacobian, "tip": arm3r.verify.kinematics}[stem]
    verdict = judge(path)
    assert verdict.ok, str(verdict)


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", [name for name in IDIOMS if "q(2)" in IDIOMS[name] and "= gravity" in IDIOMS[name]])
def test_a_mistake_in_it_is_found_in_its_line(name: str, tmp_path: Path) -> None:
    """Another joint's angle in the last cosine: a wrong entry, and never a failure of the reader."""
    text = IDIOMS[name]
    place = text.rfind("q(2)")
    path = tmp_path / "gravity.m"
    path.write_text(text[:place] + "q(1)" + text[place + 4 :])
    verdict = arm3r.verify.gravity(path)
    assert not verdict.ok and all(one.entry for one in verdict.findings), str(verdict)


def values(expression: str, *, before: str = "") -> Any:
    program = MatlabProgram(f"function y = f(x)\n{before}\ny = {expression};\nend\n", "f.m")
    return program.call([0.3, -1.2, 2.0])[0]


A = "A = [1 2 3; 4 5 6; 7 8 10];"
NUMBERS = {
    "round(-2.5)": -3,
    "round(2.5)": 3,
    "fix(-2.7)": -2,
    "ceil(-2.7)": -2,
    "rem(-5, 3)": -2,
    "mod(-5, 3)": 1,
    "wrapToPi(3*pi)": math.pi,
    "wrapToPi(-pi)": -math.pi,
    "wrapToPi(7)": 7 - 2 * math.pi,
    "wrapTo2Pi(-1)": 2 * math.pi - 1,
    "atan2d(1, -1)": 135,
    "asind(0.5)": 30,
    "sec(0.4)*cos(0.4)": 1,
    "norm([3 4])": 5,
    "norm([3; 4], 1)": 7,
    "norm([3 -4], inf)": 4,
    "norm([3 -4], 'inf')": 4,
    "norm([2 0; 0 1])": 2,
    "norm([1 2; 2 4], 'fro')": 5,
    "max([3 9 2])": 9,
    "min([4; -1])": -1,
    "max(3, 5)": 5,
    "sum(sum(A))": 46,
    "sum(A, 'all')": 46,
    "sum(A(:))": 46,
    "mean([1 2 6])": 3,
    "prod([2 3 4])": 24,
    "rank(A)": 3,
    "det(A)": -3,
    "trace(A)": 16,
    "numel(A)": 9,
    "length(zeros(2, 7))": 7,
    "isempty([])": 1,
    "isempty(A)": 0,
    "all(A(:) > 0)": 1,
    "any(A(:) > 9)": 1,
    "strcmp('a', 'b')": 0,
    "strcmpi('Ab', 'aB')": 1,
    "isequal(A, A)": 1,
    "isequal([1 2], [1 3])": 0,
    "isfield(struct('a', 1), 'a')": 1,
    "nargin": 1,
    "vecnorm([3 4; 6 8], 2, 2)": [[5], [10]],
    "vecnorm([3 4; 4 3])": [[5, 5]],
    "A(end, end)": 10,
    "A(8)": 6,
    "1:3 == [1 5 3]": [[1, 0, 1]],
    "cross([1 0 0], [0 1 0])": [[0, 0, 1]],
    "kron([1 2], [1; 1])": [[1, 2], [1, 2]],
    "repmat([1 2], 2, 2)": [[1, 2, 1, 2], [1, 2, 1, 2]],
    "triu(A)": [[1, 2, 3], [0, 5, 6], [0, 0, 10]],
    "tril(A, -1)": [[0, 0, 0], [4, 0, 0], [7, 8, 0]],
    "fliplr([1 2 3])": [[3, 2, 1]],
    "linspace(0, 1, 3)": [[0, 0.5, 1]],
    "size(zeros(2, 5))": [[2, 5]],
    "reshape(1:6, 2, 3)": [[1, 3, 5], [2, 4, 6]],
    "max(A, [], 2)": [[3], [6], [10]],
    "max(A)": [[7, 8, 10]],
    "cumsum([1 2 3])": [[1, 3, 6]],
    "expm([0 -pi/2; pi/2 0])": [[0, -1], [1, 0]],
    "pinv([2 0; 0 4])": [[0.5, 0], [0, 0.25]],
    "[1 2]./[2 4]": [[0.5, 0.5]],
    "2.\\[2 4]": [[1, 2]],
    "1./[1 2]": [[1, 0.5]],
    "cellfun(@(c) c*2, {1, 2})": [[2, 4]],
    "arrayfun(@sqrt, [4; 9])": [[2], [3]],
    "cell2mat({1, 2})": [[1, 2]],
    "A(A > 7)'": [[8, 10]],
    "A(2, [true false true])": [[4, 6]],
}


@pytest.mark.parametrize("expression", NUMBERS)
def test_a_function_has_the_value_of_its_formula(expression: str) -> None:
    assert np.allclose(values(expression, before=A), NUMBERS[expression], rtol=1e-14, atol=1e-15)


STRANGE = {  # what is said of a line; each once hung the reader, failed in it, or gave another number
    "while true\nend": "takes more than 20000 steps",
    "for i = 1:20000, for k = 1:20000, end, end": "takes more than 20000 steps",
    "y = exist(x);": "a text is needed here",
    "y = exist({1});": "a text is needed here",
    "y = cellfun(@sin, 'abc');": "is read of matrices and cell arrays",
    "y = cellfun(@(c) {c}, {1, 2});": "gives other than single numbers",
    "y = cellfun(@sin, {1}, 'ErrorHandler', 'z');": "is read of matrices and cell arrays",
    "s.a = 1; y = arrayfun(@(k) k, s);": "is read of matrices and cell arrays",
    "y = feval();": "feval takes a function",
    "y = eps(100);": "eps is read with 0 arguments, got 1",
    "y = round(2.345, 2);": "round is read with 1 argument, got 2",
    "y = vecnorm([3 4], 1);": "vecnorm is read with the order 2",
    "y = norm([1 2], 'x');": "norm with 'x' is not read",
    "c = {5}; c{1}.m = 3;": "is set of what is no single structure",
}


@pytest.mark.parametrize("line", STRANGE)
def test_a_strange_line_is_one_sentence(line: str) -> None:
    with pytest.raises(ProgramError, match=re.escape(STRANGE[line])):
        values("0", before=line)


UNREAD = {
    "erf(x)": "'erf' is not known",
    "sum(A, 3)": "goes along dimension 1 or 2",
    "['a' 3]": "a number beside a text",
    "sin('a')": "sin of a text is not read",
    "'a' + 1": "is not a number",
    "zeros(101)": "a matrix of 101 x 101 is too large",
}


@pytest.mark.parametrize("expression", UNREAD)
def test_what_is_not_read_is_said(expression: str) -> None:
    with pytest.raises(Unread, match=UNREAD[expression].replace("(", "\\(")):
        values(expression, before=A)


@pytest.mark.sample(30)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_wrong_argument_is_one_line(name: str) -> None:
    """No argument makes the reader itself fail."""
    for arguments in ("()", "('a')", "({1})", "(struct('a', 1))", "(x, x, x, x)", "([])", "(x', 'a')", "({}, {}, 1)"):
        try:
            values(f"{name}{arguments}")
        except ProgramError as error:
            assert "\n" not in str(error)


def test_over_a_hundred_functions_are_known() -> None:
    assert len(set(FUNCTIONS)) > 100


@pytest.mark.parametrize("is_right", [True, pytest.param(False, marks=pytest.mark.gate)])
def test_five_thousand_terms_in_a_line_are_read(is_right: bool, tmp_path: Path) -> None:
    terms = "+".join(["q(1)*0*sin(q(2))*cos(q(3))"] * 5000)
    path = tmp_path / "gravity.m"
    path.write_text(
        PLAIN.replace("G = [0; ", f"G = [0; {terms}").replace("cos(q(2))", "cos(q(2))" if is_right else "sin(q(2))")
    )
    verdict = arm3r.verify.gravity(path)
    assert verdict.ok == is_right and [one.entry for one in verdict.findings] == ([] if is_right else [[2]])


def test_persistent_values_stay_from_call_to_call() -> None:
    text = "function y = f(x)\npersistent n\nif isempty(n), n = 0; end\nn = n + x;\ny = n;\nend\n"
    program = MatlabProgram(text, "f.m")
    assert [float(program.call(2.0)[0].item()) for _ in range(3)] == [2, 4, 6]


def test_a_law_has_persistent_variables_of_its_own_in_each_run(scenario_of_law: Any) -> None:
    text = (
        "function tau = f(q)\npersistent n\nif isempty(n), n = 0; end\nn = n + 1;\ntau = [0; 0; min(n, 50)/50];\nend\n"
    )
    first, second = (scenario_of_law(text) for _ in range(2))
    assert np.array_equal(first, second) and np.abs(first).max() > 0


def test_functions_in_files_beside_it_are_called(tmp_path: Path) -> None:
    (tmp_path / "numbers.m").write_text(
        "function [a2, a3, m2, m3, g] = numbers()\n[a2, a3] = own();\nm2 = 0.785; m3 = m2; g = 9.80665;\nend\n"
        "function [x, y] = own()\nx = 1; y = 1;\nend\n"
    )
    path = tmp_path / "gravity.m"
    path.write_text(re.sub("a2 = .*", "[a2, a3, m2, m3, g] = numbers();", PLAIN, count=1))
    verdict = arm3r.verify.gravity(path)
    assert verdict.ok, str(verdict)
    (tmp_path / "other.m").write_text(
        "function n = other()\npersistent k\nif isempty(k), k = 0; end\nk = k + 1;\nn = k;\nend\n"
    )
    path.write_text(PLAIN.replace("cos(q(2))", "cos(q(2))*other()"))
    assert arm3r.verify.gravity(path).ok  # what is persistent begins anew with each evaluation, beside it, too
    (tmp_path / "other.m").write_text("function n = other()\nn = gravity([0; 0; 0]);\nend\n")
    with pytest.raises(arm3r.UnjudgedError, match=r"gravity\.m calls itself through other files"):
        arm3r.verify.gravity(path)
    path.write_text(re.sub("a2 = .*", "[a2, a3, m2, m3, g] = numbers();", PLAIN, count=1))
    (tmp_path / "numbers.m").write_text("function [a2, a3] = numbers()\nx = [1 2];\na2 = x(3);\na3 = 1;\nend\n")
    (finding,) = arm3r.verify.gravity(path).findings
    assert "index 3 is out of range" in finding.cause and "(in numbers.m:3)" in finding.cause and finding.line == 2
    (tmp_path / "numbers.m").write_text("function [a2, a3] = numbers()\nsyms a2 a3\nend\n")
    with pytest.raises(arm3r.UnjudgedError, match=r"numbers\.m:2:1: `syms` is not read"):
        arm3r.verify.gravity(path)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "latin-1", "utf-8"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_files_of_other_editors_are_read(encoding: str, end: str, tmp_path: Path) -> None:
    path = tmp_path / "gravity.m"
    path.write_bytes(f"% für den Arm\n{PLAIN}".replace("\n", end).encode(encoding))
    assert arm3r.verify.gravity(path).ok
    path = tmp_path / "gravity.py"
    text = "# für den Arm\nfrom math import cos\n\ndef gravity(q):\n    t3 = -0.785*9.80665*0.5*cos(q[1] + q[2])\n"
    text += "    return [0, -(0.785/2 + 0.785)*9.80665*cos(q[1]) + t3, t3]\n"
    path.write_bytes(text.replace("\n", end).encode(encoding))
    assert arm3r.verify.gravity(path).ok


REFUSED = {
    "q = [1 2 3];\nG = q*2;\n": ":1:1: this is a script: what is judged is a function of the joint angles",
    "classdef Arm\nmethods\nfunction G = gravity(o, q)\nend\nend\nend\n": "`classdef` is not read; write the method",
    "function G = gravity(q)\nsyms a b\nG = q;\nend\n": "`syms` is not read; write the symbols at the head of a script",
    "function G = gravity(q)\ng = 'open;\nG = q;\nend\n": ':2:5: "\'" begins a text that does not end in its line',
    "function G = gravity(q)\nfor i = 1:3\nG = q;\n": ":2:1: `for` is not closed by `end`: line 4 has",
    "function G = gravity(q)\narguments\n q\n": "the block `arguments` is not closed",
    "function G = gravity(q)\nG = q\n  + 1 2;\nend\n": "is needed here",
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_cannot_be_read_has_its_place_and_a_remedy(text: str, tmp_path: Path) -> None:
    path = tmp_path / "gravity.m"
    path.write_text(text)
    with pytest.raises(arm3r.UnjudgedError) as raised:
        arm3r.verify.gravity(path)
    assert REFUSED[text] in str(raised.value) and len(str(raised.value).splitlines()) == 1


@pytest.fixture
def scenario_of_law(tmp_path: Path) -> Any:
    def run(text: str) -> Any:
        path = tmp_path / "law.m"
        path.write_text(text)
        scenario = arm3r.Scenario("format: 1\ntime: {stop: 0.2}\n")
        return scenario.run(controller=path)["tau3"]

    return run
