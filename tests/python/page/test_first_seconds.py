"""What the live page shows in its first ten seconds: contact, a sentence, and its number."""

from __future__ import annotations

import re
import time
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp.live import page as live_page
from arm3r_cpp.live import page_data
from page_visitor import SIZES, Visitor

pytestmark = [pytest.mark.needs("page"), pytest.mark.sample(1)]

TOUCHES = "#scene-canvas[aria-label*='in contact with the wall, ']:not([aria-label*='not in contact'])"


def now(visitor: Visitor) -> float:
    return float(visitor.text_of("#time").split()[0])


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
def test_the_first_ten_seconds_hold_contact_a_sentence_and_a_number(browser: Any, address: str, size: str) -> None:
    with Visitor(browser, size, motion=True) as visitor:
        visitor.open(address)
        opened = time.monotonic()
        assert 4 < now(visitor) < 6  # the wall meets the tip at 5.36 s
        assert "after the contact at 5.36 s: it grows to 232 N" in visitor.text_of("#watch")
        assert visitor.page.locator("#watch").is_visible()
        visitor.page.wait_for_selector(TOUCHES, state="attached")
        assert time.monotonic() - opened < 10
        assert re.search(r", [\d.]+ N$", visitor.page.get_attribute("#scene-canvas", "aria-label"))
        visitor.check()


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
def test_nothing_moves_where_the_system_asks_for_less_motion(browser: Any, address: str, size: str) -> None:
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        assert visitor.page.get_attribute("#play", "aria-label") == "Play"
        first = now(visitor)
        visitor.page.wait_for_timeout(500)
        assert now(visitor) == first == 10
        assert visitor.page.get_attribute("#scene-canvas", "aria-label").endswith("in contact with the wall, 232 N")


def test_a_short_contact_is_slowed_down(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop", motion=True) as visitor:
        visitor.open(address)
        visitor.choose("lecture/12_wall_acts_on_arm")
        assert visitor.page.input_value("#speed") == "0.01"
        assert "it ends after 73.8 ms" in visitor.text_of("#watch")
        visitor.page.wait_for_selector(TOUCHES, state="attached")


def test_a_recorded_run_plays_at_once(browser: Any, tmp_path: Any) -> None:
    run = arm3r.Scenario.example("moving_wall").run()
    (tmp_path / "run.html").write_text(live_page.html("live.html", page_data.of_run(run)))
    with Visitor(browser, "laptop", motion=True) as visitor:
        visitor.open((tmp_path / "run.html").as_uri())
        assert now(visitor) > 4 and visitor.page.get_attribute("#play", "aria-label") == "Pause"
        assert "it grows to 232 N" in visitor.text_of("#watch")
        visitor.check()


def test_an_edit_does_not_begin_to_play(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop", motion=True) as visitor:
        visitor.open(address)
        visitor.page.keyboard.press("Home")
        visitor.set_slider("wall.contact.stiffness", 700)
        visitor.settle()
        assert now(visitor) == 0 and visitor.page.get_attribute("#play", "aria-label") == "Play"
        assert "232 N" not in visitor.text_of("#watch")
