"""Files that are dropped on the live page, or opened with it: scenarios, measurements, robots."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.commands.interchange.import_urdf import main
from page_visitor import SIZES, Visitor

pytestmark = [pytest.mark.needs("page"), pytest.mark.sample(4)]

DROP = """([name, text]) => {
  const data = new DataTransfer();
  data.items.add(new File([text], name));
  for (const kind of ['dragover', 'drop']) {
    document.querySelector('.cm-content').dispatchEvent(
      new DragEvent(kind, { dataTransfer: data, bubbles: true, cancelable: true }));
  }
}"""


def choose(visitor: Visitor, file: Path) -> None:
    """As with the button in the menu."""
    visitor.page.set_input_files("#file", file)
    visitor.page.wait_for_timeout(100)
    visitor.settle()


def log_of(run: arm3r.Run, error: float) -> str:
    """Joint 1 in degrees, with an error, rad, and the tip in mm, at times of its own; and a column of another kind."""
    times = np.arange(0.0005, 9.9, 0.01)
    rows = ["time;q1 [deg];tip_x [mm];temperature"]
    for t in times:
        q1, x = (np.interp(t, run.t, run[name]) for name in ("q1", "tip_x"))
        rows.append(f"{t:.6g};{np.degrees(q1 + error):.9g};{1000 * x:.9g};21".replace(".", ","))
    return "\n".join(rows) + "\n"


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
def test_a_measurement_stands_beside_the_run(browser: Any, address: str, tmp_path: Path, size: str) -> None:
    file = tmp_path / "bench.csv"
    file.write_text(log_of(arm3r.Scenario.example("moving_wall").run(), 0.25))
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        choose(visitor, file)
        told = visitor.text_of("#status")
        assert told.startswith("bench.csv is drawn beside the run: q1, tip_x; not drawn")
        assert told.endswith(": temperature")
        notes = [note.text_content() for note in visitor.page.locator(".measured-note").all()]
        assert notes[0] == "bench.csv (broad): off by 14.3 °" and notes[1].endswith("mm")  # 0.25 rad
        visitor.set_slider("initial.q[0]", 600)
        visitor.settle()
        assert visitor.page.locator(".measured-note").first.text_content() != notes[0]  # it is that of the new run
        if size == "phone":
            visitor.page.click('[data-tab="plots"]')
        visitor.page.click("#measured-end")
        visitor.settle()
        assert visitor.page.locator(".measured-note").count() == 0
        visitor.check()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("q1,q2\n1,2\n1,2\n", "bad.csv:1: a column t or time, in s, is needed, got q1, q2"),
        ("t,a\n0,1\n1,2\n", "bad.csv:1: no column has a name that the run has, such as q1 or tip_x, got t, a"),
        ("t,q1\n0,1\n1,x7\n", "bad.csv:3: q1 is a number, got x7"),
        ("t,q1\n# a note\n0,1\n1\n", "bad.csv:4: a row has 2 cells as the first line has, got 1"),
        ("t,q1\n1,1\n0,1\n", "bad.csv:3: time is a number that does not decrease, got 0"),
        ("t,q1,q1\n0,1,1\n1,1,1\n", "bad.csv:1: each column is needed once, got q1 twice"),
        ("t,q1\n", "bad.csv: a line of names and at least two rows of numbers are needed, got 1 lines"),
    ],
)
def test_a_measurement_that_cannot_be_read_is_told_where(browser: Any, address: str, text: str, told: str) -> None:
    with Visitor(browser, "phone") as visitor:
        visitor.open(address)
        visitor.page.evaluate(DROP, ["bad.csv", text])
        visitor.page.wait_for_selector("#note[open]")
        assert visitor.text_of("#note-text").startswith(told)
        visitor.page.keyboard.press("Escape")
        assert not visitor.page.is_visible("#note")
        visitor.check()


def test_a_scenario_opens(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        visitor.page.evaluate(DROP, ["mine.yaml", "format: 1\ntime: {stop: 1}\n"])
        visitor.page.wait_for_selector("#scenario-name:text-is('mine')")
        visitor.settle()
        assert visitor.hash() == arm3r.Scenario("format: 1\ntime: {stop: 1}\n", file="mine.yaml").run().summary["hash"]
        assert visitor.page.locator(".problem").count() == 0
        visitor.check()


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
def test_of_a_robot_the_page_says_which_command_makes_a_scenario_of_it(
    browser: Any, address: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], size: str
) -> None:
    """The command that is told is carried out, and the page shows what it wrote."""
    robot = tmp_path / "elbow.urdf"
    arm3r.export(arm3r.Scenario.example("robots/ur5_hybrid"), robot)
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        visitor.page.evaluate(DROP, [robot.name, robot.read_text()])
        visitor.page.wait_for_selector("#note[open]")
        assert visitor.text_of("#note pre") == "arm3r import elbow.urdf > elbow.yaml"
        assert main([str(robot)]) == 0
        (tmp_path / "elbow.yaml").write_text(capsys.readouterr().out)
        visitor.page.keyboard.press("Escape")
        choose(visitor, tmp_path / "elbow.yaml")
        assert visitor.page.locator(".problem").count() == 0
        assert visitor.text_of("#scenario-name") == "elbow"
        visitor.page.evaluate(DROP, ["arm.urdf", "<html></html>"])
        visitor.page.wait_for_selector("#note[open]")
        assert "a URDF has an element <robot>" in visitor.text_of("#note-text")
        visitor.check()


def test_the_keyboard_opens_a_file(browser: Any, address: str, tmp_path: Path) -> None:
    """By a key of the page, and by the button in the menu."""
    file = tmp_path / "mine.yaml"
    file.write_text("format: 1\ntime: {stop: 1}\n")
    with Visitor(browser, "phone") as visitor:
        visitor.page.on("filechooser", lambda _: None)  # while somebody listens the browser hands each chooser over
        visitor.open(address)
        with visitor.page.expect_file_chooser() as chooser:
            visitor.page.keyboard.press("o")
        chooser.value.set_files(file)
        visitor.page.wait_for_selector("#scenario-name:text-is('mine')")
        visitor.settle()
        visitor.page.keyboard.press("m")
        visitor.page.wait_for_selector("#open-file")
        visitor.page.focus("#open-file")
        with visitor.page.expect_file_chooser() as chooser:
            visitor.page.keyboard.press("Enter")
        chooser.value.set_files(file)
        visitor.page.wait_for_selector("#menu", state="hidden")
        visitor.settle()
        visitor.check()


def test_another_file_is_refused(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        visitor.page.evaluate(DROP, ["notes.pdf", "x"])
        visitor.page.wait_for_selector("#note[open]")
        kinds = "a scenario (.yaml), a measurement (.csv) or a robot (.urdf) is needed"
        assert visitor.text_of("#note-text") == f"notes.pdf: {kinds}"
        visitor.check()
