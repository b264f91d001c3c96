"""The live page from Python: what it is given, how it is served, written and shown, and what is said without it.

The page itself, in a browser, is the matter of test_live_page.py; here a small page stands in its place."""

from __future__ import annotations

import base64
import gzip
import json
import re
import signal
import subprocess
import threading
import time
import urllib.error
import urllib.request
import webbrowser
from collections.abc import Callable, Iterator
from html import unescape
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.commands import live as live_command
from arm3r_cpp.commands import view as view_command
from arm3r_cpp.live import page, page_data, server
from arm3r_cpp.live.show import Cell
from elbow_arms import WITH_OFFSETS, scenario_of
from elbow_truth import Truth

STAND_IN = "<html><body><main></main><script>page()</script></body></html>"
NASTY = "</script><script>alert(1)</script><!--"
NASTY_NAME = '<script>alert(1)<!--" onload="'  # a name has no /


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An installed page of two small files, and a third beside them."""
    found = tmp_path / "live"
    found.mkdir()
    for name in ("index.html", "live.html"):
        (found / name).write_text(STAND_IN)
    (found / "page.js").write_text("page = () => 0")
    monkeypatch.setattr(page, "FOLDER", found)
    return found


@pytest.fixture
def without_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "FOLDER", tmp_path / "nothing")


def short_run(**values: object) -> arm3r.Run:
    scenario = arm3r.Scenario.example("moving_wall")
    scenario.update({"time.stop": 0.2, "checks": [], **values})
    return scenario.run()


def data_in(html: str) -> dict[str, Any]:
    """What a page was given."""
    found = re.findall(r'<script type="application/json" id="arm3r-data">(.*?)</script>', html, re.DOTALL)
    assert len(found) == 1
    return json.loads(found[0])


# ---- data in the page -----------------------------------------------------------------------------------------------


def test_a_file_holds_the_run_to_the_last_bit(folder: Path, tmp_path: Path) -> None:
    run = short_run()
    run.to_html(tmp_path / "run.html")
    data = data_in((tmp_path / "run.html").read_text())
    matrix = np.frombuffer(gzip.decompress(base64.b64decode(data["matrix"]))).reshape(len(run.columns), -1)
    for name, column in zip(data["columns"], matrix, strict=True):
        assert column.tobytes() == run[name].tobytes(), name
    assert data["units"] == run.units
    assert data["summary"]["hash"] == run.summary["hash"]
    assert data["resolved"]["wall"]["contact"]["stiffness"] == 1000
    assert arm3r.Scenario(data["scenario"]).run().summary["hash"] == run.summary["hash"]


def test_a_file_holds_where_an_elbow_arm_is() -> None:
    run = scenario_of(WITH_OFFSETS, initial={"q": [0.4, -0.7, 1.1]}, time={"stop": 0.1}).run()
    data, truth = page_data.of_run(run), Truth(WITH_OFFSETS)
    points, axes = (
        np.frombuffer(gzip.decompress(base64.b64decode(data["arm"][name]))).reshape(len(run.t), -1, 3)
        for name in ("points", "axes")
    )
    frames = truth.frames(run["q"])
    joints = [frames.origins[1], frames.origins[2], frames.origins[3], truth.tip_position(run["q"])]
    assert points[:, [1, 2, 4, 6]] == pytest.approx(np.stack(joints, axis=1), abs=1e-12)
    assert axes == pytest.approx(np.stack(frames.axes, axis=1), abs=1e-12)


def test_the_same_run_gives_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    run = short_run()
    run.to_html(tmp_path / "one.html")
    run.to_html(tmp_path / "two.html")
    assert (tmp_path / "one.html").read_bytes() == (tmp_path / "two.html").read_bytes()


def test_no_text_of_a_scenario_becomes_html(folder: Path, tmp_path: Path) -> None:
    run = short_run(name=NASTY_NAME, checks=[{"name": NASTY, "count": "make", "equals": 0}])
    run.to_html(tmp_path / "run.html")
    text = (tmp_path / "run.html").read_text()
    assert text.count("<script") == STAND_IN.count("<script") + 1
    assert "alert(1)</" not in text and "<!--" not in text
    data = data_in(text)
    assert data["name"] == NASTY_NAME and data["summary"]["checks"][0]["name"] == NASTY


def test_infinity_and_nan_are_json_in_the_page() -> None:
    assert page_data._plain([float("inf"), -float("inf"), float("nan"), 1.5]) == ["inf", "-inf", None, 1.5]
    run = short_run(**{"wall.acts_on_arm": True, "controller": {"type": "hybrid"}})
    json.loads(page.as_json(page_data.of_run(run)))


def test_a_run_without_all_columns_is_refused(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(arm3r.UsageError, match=r"run it without time\.log_columns"):
        short_run(**{"time.log_columns": ["q1"]}).to_html(tmp_path / "run.html")
    assert not (tmp_path / "run.html").exists()


def test_a_partial_run_is_written_too(folder: Path, tmp_path: Path) -> None:
    scenario = arm3r.Scenario.example("moving_wall")
    scenario.update({"solver.max_steps": 2, "checks": []})
    with pytest.raises(arm3r.BudgetError) as error:
        scenario.run()
    error.value.run.to_html(tmp_path / "run.html")
    assert data_in((tmp_path / "run.html").read_text())["summary"]["outcome"] == "budget"


def test_a_run_that_was_read_from_a_file_is_written(folder: Path, tmp_path: Path) -> None:
    run = short_run()
    run.to_csv(tmp_path / "run.csv")
    arm3r.Run.load(tmp_path / "run.csv").to_html(tmp_path / "run.html")
    data = data_in((tmp_path / "run.html").read_text())
    assert data["summary"]["hash"] == run.summary["hash"] and data["report"] == ""


# ---- files ----------------------------------------------------------------------------------------------------------


def test_a_file_is_written_whole_or_not_at_all(folder: Path, tmp_path: Path) -> None:
    target = tmp_path / "run.html"
    target.mkdir()
    with pytest.raises(arm3r.OutputError, match=re.escape(str(target))):
        short_run().to_html(target)
    assert {path.name for path in tmp_path.iterdir()} == {"live", "run.html"}
    with pytest.raises(arm3r.OutputError, match="there is no such folder; create it first"):
        short_run().to_html(tmp_path / "missing" / "run.html")


@pytest.mark.parametrize("call", ["to_html", "show", "live", "view"])
def test_without_a_page_one_line_says_how_to_get_it(
    call: str, without_page: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = short_run()
    run.to_csv(tmp_path / "run.csv")
    if call in ("to_html", "show"):
        with pytest.raises(arm3r.UsageError, match="make page"):
            run.to_html(tmp_path / "run.html") if call == "to_html" else arm3r.show(run)
        assert not (tmp_path / "run.html").exists()
        return
    main, words = {"live": (live_command.main, []), "view": (view_command.main, [str(tmp_path / "run.csv")])}[call]
    assert main(words) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"arm3r-{call}: the live page is not part of this installation: ") and told.count("\n") == 1


# ---- show -----------------------------------------------------------------------------------------------------------


def test_a_cell_holds_the_page_in_a_frame(folder: Path) -> None:
    html = page.html("live.html", page_data.of_run(short_run(name=NASTY_NAME)))
    cell = Cell(html, 500)._repr_html_()
    assert cell.count("<") == 2 and "height: 500px" in cell  # the frame begins and ends: nothing of it is outside
    assert unescape(re.search(r'srcdoc="([^"]*)"', cell)[1]) == html


def test_show_opens_a_file_in_the_browser(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda address: bool(opened.append(address)) or True)
    arm3r.show(arm3r.Scenario.example("moving_wall"))
    file = Path(opened[0].removeprefix("file://"))
    assert "moving-wall" in data_in(file.read_text())["name"]
    file.unlink()


def test_show_puts_the_page_into_a_cell_of_a_notebook(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from arm3r_cpp.plot import run_figure
    from IPython import display

    shown: list[Any] = []
    monkeypatch.setattr(run_figure, "has_notebook", lambda: True)
    monkeypatch.setattr(display, "display", shown.append)
    arm3r.show(short_run(), height=400)
    assert "height: 400px" in shown[0]._repr_html_()


def test_show_takes_a_run_or_a_scenario(folder: Path) -> None:
    with pytest.raises(arm3r.UsageError, match=r"show: a run or a scenario is needed.* got str"):
        arm3r.show("moving_wall")


# ---- server and commands --------------------------------------------------------------------------------------------


@pytest.fixture
def address(folder: Path) -> Iterator[str]:
    """A server of the small page."""
    lines: list[str] = []
    options = {"port": 0, "browser": False, "say": lines.append}
    threading.Thread(target=server.serve, args=(STAND_IN,), kwargs=options, daemon=True).start()
    deadline = time.monotonic() + 20
    while not lines and time.monotonic() < deadline:
        time.sleep(0.01)
    yield lines[0].split()[0]


def fetch(address: str) -> tuple[str, bytes]:
    with urllib.request.urlopen(address, timeout=600) as answer:
        return answer.headers["Content-Type"], answer.read()


def test_the_server_gives_the_page_and_its_files(address: str) -> None:
    assert fetch(address) == ("text/html; charset=utf-8", STAND_IN.encode())
    assert fetch(address + "page.js") == ("text/javascript; charset=utf-8", b"page = () => 0")
    assert address.startswith("http://127.0.0.1:")


@pytest.mark.parametrize("path", ["../secret.txt", "%2e%2e/secret.txt", "nothing.js", "", "%00.js", "page.js/"])
def test_the_server_gives_nothing_else(address: str, path: str, tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("secret")
    connection = HTTPConnection(address.split("/")[2], timeout=600)
    connection.request("GET", "/live/" + path)
    answer = connection.getresponse()
    assert answer.status == 404 and b"secret" not in answer.read()


def test_the_server_answers_this_computer_alone(address: str) -> None:
    """A page elsewhere whose name is made to mean 127.0.0.1 does not get the run."""
    request = urllib.request.Request(address, headers={"Host": "elsewhere.example"})
    with pytest.raises(urllib.error.HTTPError, match="404"):
        urllib.request.urlopen(request, timeout=600)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["missing.yaml"], "missing.yaml: cannot be read: No such file"),
        (["movin_wall"], "did you mean moving_wall?"),
        (["."], ".: cannot be read: Is a directory"),
    ],
)
def test_live_says_what_is_wrong(words: list[str], told: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert live_command.main(words) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize("main", [live_command.main, view_command.main])
def test_a_wrong_port_is_a_usage_error(main: Callable[[list[str]], int], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["x.csv", "--port", "70000"])
    assert end.value.code == 2 and "0 to 65535 are possible" in capsys.readouterr().err


def test_a_port_in_use_is_a_usage_error(address: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    port = address.split(":")[2].rstrip("/")
    assert live_command.main(["--port", port, "--no-browser"]) == 2
    assert f"--port {port}: cannot be used" in capsys.readouterr().err


def test_live_takes_a_file_an_example_and_a_text_with_mistakes(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("format: 1\ncontroler: {}\n")
    mine = live_command.scenario_data(str(tmp_path / "mine.yaml"))
    assert mine == {"name": "mine", "scenario": "format: 1\ncontroler: {}\n"}
    assert "name: moving-wall" in live_command.scenario_data("moving_wall")["scenario"]
    assert live_command.scenario_data(None) is None


def test_ctrl_c_ends_the_server_cleanly(folder: Path, scripts: Path, tmp_path: Path) -> None:
    """The program itself, told by its environment of no page but of one in a small package beside it."""
    code = (
        f"import sys; from pathlib import Path; from arm3r_cpp.live import page; page.FOLDER = Path({str(folder)!r}); "
        "from arm3r_cpp.commands import entry_points; sys.argv = ['arm3r-live', '--no-browser']; "
        "sys.exit(entry_points.live())"
    )
    process = subprocess.Popen(
        [scripts / "python", "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    line = process.stdout.readline()
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/ shows the page; Ctrl-C ends it\n", line)
    assert fetch(line.split()[0])[1] == STAND_IN.encode()
    process.send_signal(signal.SIGINT)
    assert process.wait(600) == 0
    assert process.stderr.read() == ""


def test_ctrl_c_is_what_it_was_when_the_server_has_ended() -> None:
    before = signal.getsignal(signal.SIGINT)
    server.serve("", port=0, browser=False, say=lambda line: signal.raise_signal(signal.SIGINT))
    assert signal.getsignal(signal.SIGINT) is before


# ---- the guided stops -----------------------------------------------------------------------------------------------


def stops(root: Path) -> list[dict[str, Any]]:
    return json.loads((root / "web/page/src/parts/stops.json").read_text())


def test_every_guided_stop_shows_what_it_says(root: Path) -> None:
    """What each stop claims, before and after the change that it proposes, holds in a run of the library."""
    for stop in stops(root):
        scenario = arm3r.Scenario.example(stop["scenario"])
        for values, claims in ((stop["set"], stop["before"]), (stop["then"], stop["after"])):
            for path, value in values.items():
                scenario.edit(path, value, "stops.json")
            scenario["checks"] = claims
            run = scenario.run()
            assert run.passed, (stop["title"], run.checks)
