"""Predict, then run: a curve is drawn in the live page before the run is shown, and told how far it is from it."""

from __future__ import annotations

import json
import re
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from conftest import ROOT
from page_visitor import SIZES, Visitor, percentile, tasks_of

pytestmark = [pytest.mark.needs("page"), pytest.mark.sample(1)]

HYBRID = "force_control/hybrid_first_contact"
PANEL = '.plot[aria-label="Pressing force"]'
# How many points of the right half of a panel have the colour of the force.
COLOURED = """([panel, colour]) => {
  const canvas = document.querySelector(panel).querySelector('canvas');
  const left = canvas.width / 2 | 0;
  const { data } = canvas.getContext('2d').getImageData(left, 0, canvas.width - left, canvas.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (colour.every((part, k) => Math.abs(data[i + k] - part) < 12)) count += 1;
  }
  return count;
}"""
FORCE = [0xD5, 0x5E, 0x00]
CONTACT = [0xE6, 0x9F, 0x00]


def coloured(visitor: Visitor, colour: list[int]) -> int:
    visitor.settle()
    count: int = visitor.page.evaluate(COLOURED, [PANEL, colour])
    return count


def numbers(text: str) -> list[float]:
    return [float(one) for one in re.findall(r"\d+(?:\.\d+)?", text)]


def begin(visitor: Visitor, name: str) -> None:
    visitor.choose(name)
    if visitor.page.is_visible('[data-tab="plots"]'):
        visitor.page.click('[data-tab="plots"]')
    visitor.page.click("#predict-start")
    visitor.settle()


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
def test_a_curve_that_is_drawn_by_keys_is_as_far_from_the_run_as_is_told(browser: Any, address: str, size: str) -> None:
    """The curve is level: its distance is that of one number from the force."""
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        begin(visitor, HYBRID)
        pad = visitor.page.locator(".pad")
        assert pad.get_attribute("role") == "slider" and "Pressing force, N" in pad.get_attribute("aria-label")
        assert pad.evaluate("(one) => one === document.activeElement")
        assert coloured(visitor, FORCE) == coloured(visitor, CONTACT) == 0  # the run is hidden
        for key in ("Home", "Shift+ArrowUp", "Shift+ArrowUp", "ArrowUp"):
            visitor.page.keyboard.press(key)
        level = float(pad.get_attribute("aria-valuenow"))
        start, stop = numbers(pad.get_attribute("aria-valuetext"))[-1], 0.0
        visitor.page.keyboard.press("End")
        stop = numbers(pad.get_attribute("aria-valuetext"))[-1]
        visitor.page.keyboard.press("Enter")
        visitor.settle()
        run = arm3r.Scenario.example(HYBRID).run()
        inside = (run.t >= start) & (run.t <= stop)
        off = np.abs(run["force"][inside] - level)
        mean, most, when, own, contacts = numbers(visitor.text_of("#predict-say"))
        assert mean == pytest.approx(np.sqrt(np.mean(off**2)), rel=0.02)
        assert most == pytest.approx(off.max(), rel=0.01)
        assert run["force"][np.abs(run.t - when).argmin()] == pytest.approx(
            run["force"][inside][off.argmax()], rel=0.02
        )
        assert (own, contacts) == (1, 1)
        assert coloured(visitor, FORCE) > 20 and coloured(visitor, CONTACT) > 200
        assert visitor.page.locator(".pad").count() == 0
        visitor.page.click("#predict-end")
        visitor.settle()
        assert not visitor.page.is_visible("#predict")
        visitor.check()


def test_a_curve_is_drawn_by_the_mouse(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        begin(visitor, HYBRID)
        pad = visitor.page.locator(".pad")
        box = pad.bounding_box()
        high = float(pad.get_attribute("aria-valuemax"))
        places = [(0.3, 0.8), (0.5, 0.2), (0.9, 0.2)]
        for i, (x, y) in enumerate(places):
            visitor.page.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"], steps=4)
            if i == 0:
                visitor.page.mouse.down()
        visitor.page.mouse.up()
        assert 0.6 * high < float(pad.get_attribute("aria-valuenow")) < 0.95 * high
        visitor.page.keyboard.press("End")
        assert float(pad.get_attribute("aria-valuenow")) < 0.2 * high  # the pen has not come so far
        visitor.page.click("#predict-see")
        visitor.settle()
        assert "Your curve is" in visitor.text_of("#predict-say")
        assert visitor.page.text_content("#predict-see") == "Draw again"
        before = visitor.text_of("#predict-say")
        visitor.set_slider("wall.contact.stiffness", 700)
        visitor.settle()
        assert visitor.text_of("#predict-say") != before  # of the run that is shown
        visitor.check()


def test_a_key_begins_and_ends_a_prediction(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        visitor.page.keyboard.press("d")
        visitor.settle()
        assert visitor.text_of("#watch") == "Draw what you expect, then see it."
        assert visitor.page.get_attribute("#predict-start", "aria-pressed") == "true"
        visitor.page.keyboard.press("d")
        visitor.settle()
        assert visitor.page.get_attribute("#predict-start", "aria-pressed") == "false"
        assert visitor.text_of("#watch").startswith("Watch the pressing force")
        visitor.check()


@pytest.mark.gate
def test_the_main_thread_is_free_while_a_curve_is_drawn(browser: Any, address: str) -> None:
    """At most 8 ms of a frame in 99 of 100, no task over 50 ms; also while the run then plays beside the curve."""
    with Visitor(browser, "laptop", motion=True) as visitor:
        visitor.open(address)
        begin(visitor, HYBRID)
        box = visitor.page.locator(".pad").bounding_box()
        browser.start_tracing(page=visitor.page, categories=["toplevel", "devtools.timeline"])
        visitor.page.mouse.move(box["x"] + 5, box["y"] + 40)
        visitor.page.mouse.down()
        for step in range(100):
            visitor.page.mouse.move(box["x"] + 5 + 2 * step, box["y"] + 40 + 30 * np.sin(step / 9))
        visitor.page.mouse.up()
        visitor.page.click("#predict-see")
        visitor.page.wait_for_timeout(2000)
        tasks, frames = tasks_of(json.loads(browser.stop_tracing()))
        visitor.check()
    print(f"\nmain thread, {len(frames)} frames: p99 {percentile(frames, 0.99):.2f} ms; longest {max(tasks):.2f} ms")
    assert percentile(frames, 0.99) <= 8
    assert max(tasks) <= 50


def test_the_place_of_the_tip_can_be_drawn(browser: Any, address: str) -> None:
    """Another curve is chosen, and its panel shown."""
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        begin(visitor, "lecture/05_free_fall")
        visitor.page.select_option("#predict-curve", "tip_z")
        visitor.settle()
        visitor.page.click("#predict-see")
        visitor.settle()
        run = arm3r.Scenario.example("lecture/05_free_fall").run()
        fall = 1000 * np.abs(run["tip_z"] - run["tip_z"][0]).max()
        assert numbers(visitor.text_of("#predict-say"))[1] == pytest.approx(fall, rel=0.01)
        assert "mm from the run" in visitor.text_of("#predict-say")
        visitor.check()


def test_an_angle_is_drawn_in_the_unit_of_its_panel(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        begin(visitor, "lecture/05_free_fall")
        visitor.page.select_option("#predict-curve", "q2")
        visitor.settle()
        visitor.page.click("#predict-see")
        visitor.settle()
        run = arm3r.Scenario.example("lecture/05_free_fall").run()
        most = np.degrees(np.abs(run["q2"] - run["q2"][0]).max())
        assert "° from the run" in visitor.text_of("#predict-say")
        assert numbers(visitor.text_of("#predict-say"))[1] == pytest.approx(most, rel=0.01)
        visitor.page.keyboard.press("u")  # radians: the curve was drawn in degrees
        visitor.settle()
        assert not visitor.page.is_visible("#predict")
        visitor.check()


STOPS = json.loads((ROOT / "web/page/src/parts/stops.json").read_text())


@pytest.mark.gate
@pytest.mark.parametrize("size", SIZES)
def test_a_guided_stop_asks_before_it_shows(browser: Any, address: str, size: str) -> None:
    """Each stop with a prediction asks its question, and gives its answer only after the run is seen."""
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        visitor.page.click("#tour-start")
        for stop in STOPS:
            visitor.settle()
            assert visitor.page.is_visible("#tour-predict") == ("predict" in stop), stop["title"]
            if "predict" in stop:
                visitor.page.click("#tour-predict")
                visitor.settle()
                assert visitor.text_of("#predict-say").startswith(stop["predict"]["question"])
                assert not visitor.page.is_visible("#tour-answer")
                visitor.page.click("#predict-see")
                visitor.settle()
                assert visitor.page.is_visible("#tour-answer")
                assert "Your curve is" in visitor.text_of("#predict-say")
            if stop["title"] == "How late may a torque be?":
                assert stop["predict"]["question"] == "Will it bounce?"
                assert numbers(visitor.text_of("#predict-say"))[-1] > 5  # contacts
            visitor.page.click("#tour-next")
        assert not visitor.page.is_visible("#predict")
        visitor.check()
