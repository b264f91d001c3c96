"""Text of a submission reaches no terminal, table or page as it is, and can forge no line."""

from __future__ import annotations

import csv
import html
import json
import random
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp._messages import as_json, shown
from arm3r_cpp.commands import exercise, run, verify
from arm3r_cpp.exercises.folder import Row
from arm3r_cpp.exercises.mark import Mark
from arm3r_cpp.exercises.table import csv_of
from arm3r_cpp.exercises.tasks import TASKS
from arm3r_cpp.user_functions.python_process import PythonProcess

CONTROLS = [*map(chr, range(32)), *map(chr, range(0x7F, 0xA0))]
BIDI = [*"\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069\u200e\u200f\u061c"]
UNSEEN = [
    *"\u00ad\u034f\u115f\u200b\u200c\u200d\u2028\u2029\u2060\u3164\ufe0f\ufeff\ufff9",
    "\U000e0041",
    "\U000e0101",
    "\ud800",
]
HARMFUL = [*CONTROLS, *BIDI, *UNSEEN]
FORGED = "\x1b[2J\x1b]0;x\x07\u202e\r\nmine.py: gravity torque: right\u2028\x85\ud800"


def is_harmless(text: str) -> bool:
    return not any(one in text for one in HARMFUL if one != "\n")


def test_what_does_harm_is_escaped_and_what_does_not_stays() -> None:
    assert is_harmless(shown("".join(HARMFUL))) and "\n" not in shown("\n")
    for text in ("J(2,1) = -a2*sin(q1)", "Jörg, 李, Ωμέγα, \\alpha", ""):
        assert shown(text) == text
    assert len({shown(one) for one in HARMFUL}) == len(HARMFUL)
    assert json.loads(as_json({"x": "".join(HARMFUL) + "Jörg"})) == {"x": "".join(HARMFUL) + "Jörg"}
    assert is_harmless(as_json(["".join(HARMFUL)]))


RAISES = "def gravity(q):\n    raise ValueError(%r)\n"
ANSWERS = '''import json, os, sys
def gravity(q):
    frame, found = sys._getframe(), {}
    while frame: found, frame = {**frame.f_locals, **found}, frame.f_back
    stream, head = found["answers"], {HEAD}
    text = head if isinstance(head, bytes) else json.dumps(head).encode()
    stream.write(__import__("struct").pack("<II", *(LENGTHS or (len(text), len({BODY})))) + text + {BODY})
    stream.flush()
    os._exit(0)
'''  # fmt: skip


def answering(head: str, body: str = "b''", lengths: str = "None") -> str:
    """A formula that answers its judge itself."""
    text = ANSWERS.replace("{HEAD}", head).replace("{BODY}", body).replace("LENGTHS", lengths)
    return text.replace("ROWS", "len(found['table'])")


def test_a_message_of_a_formula_forges_no_line(tmp_path: Path, capsys: Any) -> None:
    for text in (RAISES % FORGED, answering(repr({"error": FORGED, "line": 2}))):
        path = tmp_path / "gravity.py"
        path.write_text(text)
        for options in ([], ["--json"]):
            assert verify.main([str(path), *options]) == 11
            out, error = capsys.readouterr()
            assert is_harmless(out + error)
            assert not any(line.startswith(("mine.py", " mine.py")) for line in (out + error).splitlines())
        page = arm3r.verify.gravity(str(path))._repr_html_()
        assert is_harmless(html.unescape(page))


def test_a_formula_that_ends_its_process_has_few_edits_tried(tmp_path: Path, monkeypatch: Any) -> None:
    """Each of them would start a process, and some wait before they end it."""
    started = []
    start = PythonProcess._start
    monkeypatch.setattr(PythonProcess, "_start", lambda self: (started.append(self), start(self)))
    path = tmp_path / "gravity.py"
    path.write_text(answering(repr({"error": "no", "line": 2})))
    assert not arm3r.verify.gravity(str(path))
    assert len(started) < 10


@pytest.mark.parametrize(
    "text",
    [
        answering("b'[' * 60_000"),
        answering("b'{' * 100"),
        answering("b'\\xff\\xfe'"),
        answering("[]"),
        answering("{}"),
        answering("{'error': 3}"),
        answering("{'error': 'x', 'line': True}"),
        answering("{'error': 'x', 'line': -4}"),
        answering("{'error': 'x', 'line': 10**400}"),
        answering("{'error': 'x'}", "bytes(8)"),
        answering("{'shape': [ROWS, True, 3]}", "bytes(24 * ROWS)"),
        answering("{'shape': [ROWS, 3.0]}", "bytes(24 * ROWS)"),
        answering("{'shape': [ROWS, -3, -1]}", "bytes(24 * ROWS)"),
        answering("{'shape': [ROWS, 2**62, 4]}"),
        answering("{'shape': [ROWS, 0, 10**30]}"),
        answering("{'shape': [ROWS, 3]}", "bytes(24 * ROWS - 8)"),
        answering("{'shape': [ROWS + 1, 3]}", "bytes(24 * (ROWS + 1))"),
        answering("{'shape': [ROWS] + [1] * 100}", "bytes(8 * ROWS)"),
        answering("{'shape': []}", "bytes(8)"),
        answering('b\'{"shape": [3], "seconds": NaN}\'', "bytes(24)"),
        answering("{'shape': [ROWS, 3], 'seconds': '1'}", "bytes(24 * ROWS)"),
        answering("{'shape': [ROWS, 3], 'seconds': -1.0}", "bytes(24 * ROWS)"),
        answering("b''", "b''", "(2**32 - 1, 2**32 - 1)"),
        answering("b'x' * 70_000", "b''"),
    ],
)
def test_a_formula_that_answers_its_judge_itself_is_not_judged(text: str, tmp_path: Path, capsys: Any) -> None:
    path = tmp_path / "gravity.py"
    path.write_text(text)
    assert verify.main([str(path)]) == 12
    out, error = capsys.readouterr()
    assert not out and len(error.splitlines()) == 1 and "breaks the connection to its judge" in error


def test_names_of_files_and_functions_forge_no_line(tmp_path: Path, capsys: Any) -> None:
    name = "\x1b[2J\nx.py: gravity torque: right\u202e"
    wrong = tmp_path / f"{name}.py"
    wrong.write_text("def gravity(q):\n    return [1, 2, 3]\n")
    calls = [
        lambda: verify.main([str(wrong)]),
        lambda: verify.main([str(tmp_path / f"{name}.m")]),
        lambda: verify.main([str(tmp_path / f"{name}.csv")]),
        lambda: verify.main([str(wrong), "--dh", str(tmp_path / f"{name}.dh")]),
        lambda: verify.main([str(wrong), "--arm", str(tmp_path / f"{name}.yaml")]),
        lambda: exercise.main(["check", "tip_torque", str(wrong)]),
        lambda: exercise.main(["check", name, str(wrong)]),
        lambda: exercise.main(["mark", str(tmp_path / name)]),
        lambda: run.main([str(tmp_path / f"{name}.yaml"), "--controller", str(wrong)]),
    ]
    for one in calls:
        assert one() in (2, 3, 11, 12)
        out, error = capsys.readouterr()
        assert is_harmless(out + error), out + error
        assert not any(line.startswith("x.py") for line in (out + error).splitlines()), out + error


def test_what_a_controller_raises_forges_no_line(tmp_path: Path, capsys: Any) -> None:
    law, scenario = tmp_path / "law.py", tmp_path / "s.yaml"
    law.write_text(f"def gravity(q):\n    raise ValueError({FORGED!r})\n")
    scenario.write_text("format: 1\nsampling: {rate: 100}\ntime: {stop: 0.1}\n")
    assert run.main([str(scenario), "--controller", str(law)]) in (3, 8)
    out, error = capsys.readouterr()
    assert is_harmless(out + error) and not any(line.startswith("mine") for line in (out + error).splitlines())


def table(names: list[str], reason: str = "") -> list[list[str]]:
    rows = [Row(name, TASKS["tip_torque"], Mark("wrong", reason)) for name in names]
    text = csv_of(rows)
    assert is_harmless(text) and len(text.splitlines()) == 1 + len(names)
    return list(csv.reader(text.splitlines()))[1:]


def test_students_of_other_names_have_other_rows_which_no_spreadsheet_computes() -> None:
    chance = random.Random(1)
    letters = [*"ab \\nrtx0'\"=+-@,;", *HARMFUL]
    names = sorted({"".join(chance.choices(letters, k=chance.randint(1, 4))) for _ in range(3000)})
    names += ["new\nline", "new line", "new\\nline", "'=a", "=a"]
    rows = table(list(dict.fromkeys(names)))
    students = [row[0] for row in rows]
    assert len(set(students)) == len(students)
    starts = ("=", "+", "-", "@", "\t", "\r")
    assert not any(cell.strip().startswith(starts) for row in rows for cell in row)
    assert table(["anna"], "=cmd|' /C calc'!A0")[0][3].startswith("'=")
