"""GNU Octave evaluates MATLAB files that are not read, confined as Python files are: the same judge, and no way out."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from arm3r_cpp.errors import UnreadError
from arm3r_cpp.user_functions import start
from arm3r_cpp.user_functions.matlab.program import MatlabProgram
from arm3r_cpp.user_functions.octave.installation import PROGRAM, installed
from arm3r_cpp.user_functions.octave.process import OctaveProcess
from arm3r_cpp.user_functions.octave.source import constants_of, functions_alone, headers_of
from arm3r_cpp.user_functions.programs import Call, Given, ProgramError, Unjudged, Unread
from formulas import octave_ways_out as ways_out
from test_sandbox import USERS, become

octave = pytest.mark.needs("octave")
STUDENTS = Path(__file__).parents[1] / "formulas" / "students"
FILES = {path.name: path for path in sorted(STUDENTS.glob("*/*.m"))}
JACOBIAN = """function J = jacobian(q)
  a2 = 1;
  a3 = 1;
  p = containers.Map();
  p('r') = a2*cos(q(2)) + a3*cos(q(2)+q(3));
  p('h') = a2*sin(q(2)) + a3*sin(q(2)+q(3));
  s1 = sin(q(1)); c1 = cos(q(1));
  J = [-s1*p('r'), -p('h')*c1, -a3*sin(q(2)+q(3))*c1
       c1*p('r'), -p('h')*s1, -a3*sin(q(2)+q(3))*s1
       0, -p('r'), -a3*cos(q(2)+q(3))];
end
"""
Q = ((0, 1, 2),)
NO_NAMESPACES = 77


@pytest.fixture(autouse=True)
def with_octave(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(PROGRAM, raising=False)


@pytest.fixture
def evaluated(tmp_path: Path) -> Iterator[Any]:
    """evaluated(text, rows): what Octave returns of the text's first function at as many states."""
    processes = []

    def evaluate(text: str, rows: int = 2, slots: Any = Q, **told: Any) -> Any:
        found = installed()
        assert found
        processes.append(OctaveProcess(text, next(iter(headers_of(text))), str(tmp_path / "gravity.m"), found))
        (tmp_path / "gravity.m").write_text(text)
        table = np.random.default_rng(1).uniform(-2, 2, (rows, 4))
        return processes[-1].evaluate(Call(slots, {}, **told), table)

    yield evaluate
    for process in processes:
        process.close()


# ---- verdicts --------------------------------------------------------------------------------------------------------


@octave
def test_a_file_that_is_not_read_is_judged_and_the_verdict_says_by_what(written: Any) -> None:
    verdict = verify.jacobian(written("jacobian.m", JACOBIAN))
    assert verdict.ok
    assert verdict.found[0].startswith("evaluated by GNU Octave ")
    assert verdict.found[0].endswith(" (line 4: 'containers.Map' is not known)")
    assert str(verdict).split(", ")[1] == verdict.found[0]


@octave
def test_a_wrong_term_is_found_though_lengths_are_equal(written: Any) -> None:
    verdict = verify.jacobian(written("jacobian.m", JACOBIAN.replace("0, -p('r'), -a3*", "0, -p('r'), -a2*")))
    (finding,) = verdict.findings
    assert finding.entry == [3, 3] and finding.reads == "-a2 C23" and finding.due == "-a3 C23"
    assert finding.old is None, "its text is not edited"


@octave
def test_numbers_of_the_text_are_compared_with_the_arms(written: Any) -> None:
    verdict = verify.jacobian(written("jacobian.m", JACOBIAN.replace("a3 = 1;", "a3 = 0.9;")))
    assert {(one.line, one.old, one.new) for one in verdict.findings} == {(3, "0.9", "1")}


@octave
def test_the_command_judges_and_prints_the_same_as_data(written: Any, command: Any) -> None:
    right, wrong = written("jacobian.m", JACOBIAN), written("b.m", JACOBIAN.replace("-s1*p", "s1*p"))
    done = command(right)
    assert done.returncode == 0 and "evaluated by GNU Octave" in done.stdout
    done = command(wrong, "--json", "--kind", "jacobian")
    assert done.returncode == 11 and "evaluated by GNU Octave" in done.stdout


@octave
@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("x = no_such_function(3);", r"jacobian\.m:3: cannot be judged: Octave says: 'no_such_function' undefined"),
        ("error('by %s', 'hand');", r"jacobian\.m:3: cannot be judged: Octave says: by hand"),
        ("x = helper(3);", r"jacobian\.m: cannot be judged: Octave says in helper\.m:2: 'nothing' undefined"),
        ("x = [1 2;", r"jacobian\.m: cannot be judged: Octave says: syntax error"),
        ("exit(0);", r"cannot be judged: it ends Octave, which evaluates it"),
        ("x = zeros(1e6);", r"cannot be judged: it needs too much memory"),
        ("x = jacobian(q);", r"cannot be judged: Octave says: max_recursion_depth exceeded"),
    ],
)
def test_what_octave_says_against_a_file_is_no_mistake(line: str, said: str, written: Any) -> None:
    written("helper.m", "function y = helper(x)\n  y = nothing;\nend\n")
    text = f"function J = jacobian(q)\n  containers.Map();\n  {line}\n  J = eye(3);\nend\n"
    with pytest.raises(arm3r.UnjudgedError, match=said) as raised:
        verify.jacobian(written("jacobian.m", text))
    assert "; Octave was asked because in line " in str(raised.value)


@octave
def test_the_readers_hint_stays(written: Any) -> None:
    path = written("jacobian.m", "function J = jacobian(q)\n  J = coss(q(1))*eye(3);\nend\n")
    with pytest.raises(arm3r.UnjudgedError, match=r"Octave says: 'coss' undefined; .* line 2 .*; is \w+ meant\?"):
        verify.jacobian(path)


@octave
def test_a_loop_without_end_is_slow(written: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arm3r_cpp.user_functions.python_process.ANSWER_TIME", 1.0)
    path = written("jacobian.m", "function J = jacobian(q)\n  containers.Map();\n  while true, disp(1), end\nend\n")
    with pytest.raises(arm3r.UnjudgedError, match="takes too long: it was stopped"):
        verify.jacobian(path)


@octave
@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("{1}", "returns a cell instead of numbers"),
        ("sqrt(-1)*ones(3)", "returns complex numbers"),
        ("zeros(3, 3, 2)", "returns an array of 3 x 3 x 2 numbers"),
        ("[]", "returns an array of 0 x 0 numbers"),
        ("zeros(3, 3 + (q(1) > 0.5))", "returns arrays of different shapes at different states"),
        ("rand(3)", "gives different numbers when it is called again"),
        ("NaN(3)", "returns NaN or infinity instead of numbers"),
    ],
)
def test_what_is_no_matrix_of_numbers_is_a_mistake(value: str, said: str, written: Any) -> None:
    text = f"function J = jacobian(q)\n  containers.Map();\n  J = {value};\nend\n"
    verdict = verify.jacobian(written("jacobian.m", text))
    assert not verdict.ok and said in verdict.findings[0].cause and "Octave" in verdict.found[0]


@octave
def test_what_is_misspelt_is_still_a_mistake(written: Any) -> None:
    """The reader takes an edit that mends the text for the cause; Octave is not asked."""
    text = JACOBIAN.replace("p = containers.Map();", "p.r = 0;").replace("p('r')", "p.r").replace("p('h')", "p.h")
    verdict = verify.jacobian(written("jacobian.m", text.replace("-s1*p.r", "-sl*p.r")))
    assert not verdict.ok and "Octave" not in str(verdict)


def test_without_octave_the_refusal_names_it(written: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(PROGRAM, "")
    with pytest.raises(UnreadError, match=r"jacobian\.m:4: .*GNU Octave, where it is installed, evaluates such a file"):
        verify.jacobian(written("jacobian.m", JACOBIAN))


def test_a_program_that_is_no_octave_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(PROGRAM, str(Path(sys.executable).resolve()))
    assert installed() is None


@pytest.mark.parametrize("text", ["x = 1;\n", "classdef Arm\nmethods\nfunction J = jacobian(q)\nend\nend\nend\n"])
def test_scripts_and_classes_are_refused_as_before(text: str, written: Any) -> None:
    with pytest.raises(arm3r.UnjudgedError) as raised:
        verify.jacobian(written("jacobian.m", text))
    assert "Octave" not in str(raised.value)


# ---- numbers ---------------------------------------------------------------------------------------------------------


@octave
@pytest.mark.sample(8)
@pytest.mark.parametrize("name", FILES)
def test_octave_and_the_reader_return_the_same(name: str, evaluated: Any) -> None:
    program = MatlabProgram(FILES[name].read_text(), name)
    count = len(program.arguments)
    slots = tuple(range(count)) if count > 2 else tuple((0, 1, 2) for _ in range(count))
    table = np.random.default_rng(1).uniform(-2, 2, (5, 4))
    try:
        ours = program.evaluate(Call(slots, {}), table)
    except ProgramError:
        pytest.skip("the reader takes no such arguments")
    assert np.allclose(evaluated(program.text, 5, slots), ours, rtol=1e-12, atol=1e-12)


@octave
def test_arguments_structures_and_globals_are_given(evaluated: Any) -> None:
    text = "function out = f(q, p)\n  global g\n  out = [p.m(2)*q(1), g*p.link.l, size(p.m, 1)];\nend\n"
    slots = (*Q, Given({"m": [1.5, 2.5], "link": {"l": 0.1}}))
    values = evaluated(text, 3, slots, outside={"g": 9.81})
    assert np.array_equal(values[:, 0, 1:], np.tile([9.81 * 0.1, 2.0], (3, 1)))


@octave
def test_one_of_several_outputs(evaluated: Any) -> None:
    text = "function [a, b, c] = f(q)\n  a = q; b = q*q'; c = {};\nend\n"
    assert evaluated(text, 4, output=1).shape == (4, 3, 3)


@octave
def test_what_a_function_prints_is_no_answer(evaluated: Any) -> None:
    text = "function out = f(q)\n  out = 1\n  fprintf('%d', 1:1000); fwrite(stdout, zeros(1, 99)); puts('x');\nend\n"
    assert evaluated(text).tolist() == [[1.0], [1.0]]


@octave
def test_a_process_that_is_no_copy(evaluated: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(start, "COPIES", False)
    assert evaluated("function out = f(q)\n  out = 1;\nend\n").tolist() == [[1.0], [1.0]]


@octave
def test_nothing_is_drawn(evaluated: Any) -> None:
    assert evaluated("function out = f(q)\n  h = figure(1); hold on; plot(q, q); out = 1;\nend\n")[0, 0] == 1.0


@octave
def test_an_octave_that_cannot_be_loaded_is_told(tmp_path: Path) -> None:
    found = installed()
    assert found
    process = OctaveProcess("function out = f(q)\nout = 1;\n", "f", "f.m", found._replace(library=str(tmp_path / "x")))
    with pytest.raises(Unread, match="GNU Octave cannot be used here"):
        process.evaluate(Call(Q, {}), np.zeros((1, 3)))
    process.close()


@octave
def test_functions_of_a_file_do_not_stand_in_the_place_of_octaves_own(evaluated: Any) -> None:
    """`strsplit` and the judge call `columns`, `size` and `numel`: Octave's."""
    text = """
function out = f(q)
  words = strsplit('a,b', ',');
  out = [numel(words), columns(q), size('x'), feval('columns', q), cellfun(@columns, {q}), cellfun('columns', {1})];
end
function n = columns(q)
  n = 7;
end
function n = numel(q)
  n = 8;
end
function n = size(q)
  n = 9;
end
"""
    assert evaluated(text)[:, 0].tolist() == [[8, 7, 9, 7, 7, 7]] * 2


# ---- the text --------------------------------------------------------------------------------------------------------

TEXT = """% function no = comment(q)
clear all
x = 3;
%{
function no = block(q)
%}
function [a, ~, b] = first(q1, ...
                           q2)
  a2 = 1; % not alone: taken as it stands
  a3 = 0.5   % alone
  m2 = 2;
  m2 = 3;
  for m3 = 1:3, end
  b = 1;
end
function second
  c = 2;
end
"""


def test_functions_and_constants_of_a_text() -> None:
    headers = headers_of(TEXT)
    assert [(one.name, one.outputs, one.inputs, one.line) for one in headers.values()] == [
        ("first", ["a", "", "b"], ["q1", "q2"], 7),
        ("second", [], [], 16),
    ]
    assert [(one.name, one.value) for one in constants_of(TEXT)] == [("a2", 1.0), ("a3", 0.5), ("c", 2.0)]
    assert all(float(TEXT[one.start : one.end]) == one.value for one in constants_of(TEXT))
    alone = functions_alone(TEXT)
    assert alone.lstrip().startswith("function [a") and alone.count("\n") == TEXT.count("\n")


# ---- the process -----------------------------------------------------------------------------------------------------


@pytest.fixture
def paths(tmp_path: Path) -> Iterator[tuple[str, ...]]:
    """Own file and folder, another's file, a FIFO, and this package."""
    own, other, fifo = tmp_path / "own/gravity.m", tmp_path / "other/secret_of_other.m", tmp_path / "own/fifo"
    for file in (own, other):
        file.parent.mkdir()
        file.write_text("function out = secret_of_other()\n  out = 1;\nend\n")
    (own.parent / "link.m").symlink_to(other)
    (own.parent / ".hidden").write_text("secret")
    os.mkfifo(fifo)
    yield str(own), str(own.parent), str(other), str(fifo), str(Path(arm3r.__file__).parent)
    assert own.read_text() == other.read_text() != ""
    assert sorted(one.name for one in own.parent.iterdir()) == [".hidden", "fifo", "gravity.m", "link.m"]


def test_the_table_of_ways_is_long_enough() -> None:
    assert len(set(ways_out.WAYS.values())) >= 80


def open_ways(paths: tuple[str, ...]) -> list[str]:
    """The ways that are open to the file `own`."""
    found = installed()
    assert found
    process = OctaveProcess(ways_out.text(*paths), "gravity", paths[0], found)
    states = np.arange(float(len(ways_out.WAYS)))[:, None]
    try:
        values = process.evaluate(Call((0,), {}), states)
        assert process.unbarred == []
    finally:
        process.close()
    return [way for way, is_open in zip(ways_out.WAYS, values, strict=True) if is_open]


@octave
@pytest.mark.parametrize("user", USERS)
def test_no_way_out(user: str, paths: tuple[str, ...]) -> None:
    words = json.dumps([USERS[user], paths])
    # No other process can enter a user namespace: one thread.
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, __file__, words], capture_output=True, text=True, env=environment)
    if done.returncode == NO_NAMESPACES:
        pytest.skip("this system has no user namespaces to try it in")
    assert done.returncode == 0, done.stderr[-2000:]
    assert json.loads(done.stdout) == []


def main(user: int, paths: list[str]) -> None:
    try:
        become(user)
    except (AssertionError, OSError):
        sys.exit(NO_NAMESPACES)
    print(json.dumps(open_ways(tuple(paths))))


@octave
def test_the_ways_are_open_outside(paths: tuple[str, ...], tmp_path: Path) -> None:
    """What is refused in the confined process is no way that is closed to everybody."""
    opened = ["processes: system", "processes: popen", "processes: fork", "read: another's file", "read: users"]
    opened += ["read: getpwnam", "read: evaluated as a function", "network: urlread of a file", "write: append"]
    numbers = {way: number for number, way in enumerate(ways_out.WAYS)}
    calls = "".join(f"printf('%d', gravity({numbers[way]}));" for way in opened)
    (tmp_path / "try.m").write_text(f"1;{ways_out.text(*paths)}{calls}")
    command = [str(shutil.which("octave-cli")), "--quiet", "--norc", str(tmp_path / "try.m")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.stdout == "1" * len(opened), done.stderr


@octave
def test_neighbours_are_called_and_the_process_ends(evaluated: Any, tmp_path: Path) -> None:
    (tmp_path / "length_of.m").write_text("function l = length_of(n)\n  l = 10*n;\nend\n")
    (tmp_path / "numbers.mat").write_text("# name: m\n# type: scalar\n3\n")
    text = "function out = f(q)\n  s = load('numbers.mat'); out = length_of(2) + s.m;\nend\n"
    assert evaluated(text)[0, 0] == 23.0


@octave
def test_a_process_that_is_closed_has_ended(tmp_path: Path) -> None:
    found = installed()
    assert found
    process = OctaveProcess("function out = f(q)\n  while true, end\nend\n", "f", "f.m", found)
    process._start()
    assert process._process
    pid = process._process.pid
    process.close()
    assert not Path(f"/proc/{pid}").exists()


@octave
def test_an_answer_is_not_forged_by_the_judges_words(evaluated: Any) -> None:
    """A function that knows how answers are written writes one; the number that it does not know makes it nothing."""
    text = "function out = f(q)\n  fwrite(stdout, zeros(1, 16)); fwrite(stdout, [0 3 2 1 1 7 1 1 7], 'double');\n"
    assert evaluated(text + "  out = 1;\nend\n").tolist() == [[1.0], [1.0]]


@octave
def test_reading_the_judges_requests_is_no_verdict(evaluated: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arm3r_cpp.system.patience.WAITING_TIME", 1.0)
    with pytest.raises(Unjudged):
        evaluated("function out = f(q)\n  fread(stdin, 100); out = 1;\nend\n")


if __name__ == "__main__":
    main(*json.loads(sys.argv[1]))
