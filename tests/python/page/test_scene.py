"""The scene of the live page: views, wall, labels, the run before, energies, unit of angles; tip and wall, dragged."""

from __future__ import annotations

import json
import re
from io import BytesIO
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.plot import style
from arm3r_cpp.plot.run_panels import ENERGIES
from page_visitor import SIZES, Visitor, percentile, tasks_of

pytestmark = [pytest.mark.needs("page"), pytest.mark.sample(4)]

VIEWS = ["whole", "side", "front", "top"]
HIDDEN = "#scene > :not(canvas) { visibility: hidden !important }"
Numbers = np.ndarray[Any, np.dtype[np.float64]]


def look(visitor: Visitor, view: str) -> None:
    visitor.page.click(f'[data-view="{view}"]')
    visitor.settle()


def middle(visitor: Visitor, selector: str) -> Numbers:
    """Of an element, px."""
    box = visitor.page.locator(selector).bounding_box()
    return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])


def picture(visitor: Visitor) -> Numbers:
    """The scene without what stands over it: shape (height, width, 3), 0 to 255, from the page's upper left corner."""
    image = pytest.importorskip("PIL.Image")
    style_of = visitor.page.add_style_tag(content=HIDDEN)
    shot = visitor.page.screenshot()
    style_of.evaluate("(one) => one.remove()")
    return np.asarray(image.open(BytesIO(shot)).convert("RGB"), dtype=float)


def drag(visitor: Visitor, selector: str, by: tuple[float, float], *, pause: float = 30) -> Numbers:
    """With the mouse, in steps with a pause (ms) after each; returns where the pointer is released, px."""
    start = middle(visitor, selector)
    visitor.page.mouse.move(*start)
    visitor.page.mouse.down()
    for share in (0.3, 0.7, 1.0):
        visitor.page.mouse.move(*(start + share * np.array(by)))
        visitor.page.wait_for_timeout(pause)
    visitor.settle()
    visitor.page.mouse.up()
    visitor.settle()
    return start + np.array(by)


def drag_by_finger(visitor: Visitor, selector: str, by: tuple[float, float]) -> Numbers:
    """As a touch screen reports it: the finger comes down, moves and is lifted."""
    start = middle(visitor, selector)
    device = visitor.context.new_cdp_session(visitor.page)

    def report(kind: str, *places: Numbers) -> None:
        points = [{"x": float(place[0]), "y": float(place[1])} for place in places]
        device.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    report("touchStart", start)
    for share in (0.3, 0.7, 1.0):
        report("touchMove", start + share * np.array(by))
        visitor.page.wait_for_timeout(30)
    visitor.settle()
    report("touchEnd")
    visitor.settle()
    return start + np.array(by)


def scenario(visitor: Visitor) -> arm3r.Scenario:
    """That the page shows."""
    with visitor.page.expect_download() as download:
        visitor.page.click("#take > summary")
        visitor.page.click("#take-yaml")
    return arm3r.Scenario.load(download.value.path())


def tip_at_start(visitor: Visitor) -> Numbers:
    shown = scenario(visitor)
    return np.asarray(shown.arm.tip_position(shown["initial.q"]))


# ---- views and wall -------------------------------------------------------------------------------------------------


def test_the_views_along_an_axis_are_orthographic(browser: Any, address: str) -> None:
    """A wall that moves along the line of sight stays where it is in the picture; in perspective it does not."""
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        for view, axis, stays in (("side", 1, True), ("top", 2, True), ("whole", 1, False)):
            look(visitor, view)
            places = []
            for place in (450, 550):
                visitor.set_slider(f"wall.point[{axis}]", place)
                visitor.settle()
                places.append(middle(visitor, "#wall-handle"))
            assert (np.abs(places[1] - places[0]).max() < 0.01) == stays, (view, places)


def test_an_infinite_wall_goes_through_the_whole_picture(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        for name, infinite in (("moving_wall", False), ("contact/energy_balance", True)):
            visitor.choose(name)
            look(visitor, "side")
            x = round(middle(visitor, "#wall-handle")[0])
            box = visitor.page.locator("#scene").bounding_box()
            column = picture(visitor)[:, x - 8 : x + 9]
            for y in (box["y"] + 12, box["y"] + box["height"] - 12):
                row = column[round(y)]
                assert (np.ptp(row.sum(axis=1)) > 15) == infinite, (name, y)


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
def test_the_scene_is_large(browser: Any, address: str, size: str) -> None:
    """It has the most room of all parts, and the arm fills it."""
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        width, height = SIZES[size]
        box = visitor.page.locator("#scene").bounding_box()
        assert box["width"] * box["height"] >= 0.33 * width * height
        colours = picture(visitor)[round(box["y"]) + 4 : round(box["y"] + box["height"]) - 4]
        dark = np.argwhere(colours.sum(axis=2) < 420)  # the arm
        assert np.ptp(dark[:, 1]) >= 0.45 * box["width"]


# The sizes of elements are told when a run has come, as where the machine is busy.
LATE = """const observe = ResizeObserver.prototype.observe;
ResizeObserver.prototype.observe = function (...what) { const waiting = setInterval(() => {
if (!document.querySelector('.outcome')) return;
clearInterval(waiting); setTimeout(() => observe.apply(this, what), 3000); }, 50); };"""


def test_a_run_that_comes_before_the_scene_knows_its_size_is_shown(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.page.add_init_script(LATE)
        visitor.open(address)
        visitor.page.wait_for_selector(".scene-label:not([hidden])")
        visitor.check()


# ---- labels ---------------------------------------------------------------------------------------------------------

BOXES = """() => Object.fromEntries([...document.querySelectorAll(
'.scene-label:not([hidden]), #views, #legend, #energies, .handle:not([hidden])')].map((one) => {
const { left, top, right, bottom } = one.getBoundingClientRect();
return [one.className === 'scene-label' ? one.textContent : `#${one.id}`, [left, top, right, bottom]]; }))"""


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("view", VIEWS)
def test_labels_cover_neither_arrows_nor_links_nor_each_other(browser: Any, address: str, size: str, view: str) -> None:
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        look(visitor, view)
        visitor.page.keyboard.press("End")
        visitor.settle()
        boxes = visitor.page.evaluate(BOXES)
        colours = picture(visitor)
        labels = [name for name in boxes if not name.startswith("#")]
        assert len(labels) >= 6, labels
        for name in labels:
            left, top, right, bottom = boxes[name]
            for other, (a, b, c, d) in boxes.items():
                assert other == name or left >= c or a >= right or top >= d or b >= bottom, (name, other)
            here = colours[round(top) : round(bottom), round(left) : round(right)]
            strong = (here.min(axis=2) < 150).mean()  # of a link or an arrow; a line of the plate is thinner
            assert strong < 0.1, (name, strong)


# ---- the run before, energies, angles -------------------------------------------------------------------------------


def test_the_run_before_stays_visible(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        look(visitor, "side")
        assert not visitor.page.is_visible("#legend-before")
        for place in (320, 300, 280):  # as one movement of the slider
            visitor.set_slider("initial.q[1]", place)
        visitor.settle()
        look(visitor, "side")
        assert visitor.page.is_visible("#legend-before")
        pale = picture(visitor)
        visitor.page.keyboard.press("g")
        visitor.settle()
        assert not visitor.page.is_visible("#legend-before")
        assert np.abs(pale - picture(visitor)).sum(axis=2).max() > 60
        visitor.page.keyboard.press("g")
        visitor.choose("stiff_wall")
        assert not visitor.page.is_visible("#legend-before")
        visitor.check()


def test_the_bars_have_the_energies_of_the_run(browser: Any, address: str) -> None:
    """Labels, order and colours are those of the figures; a bar is as long as its energy."""
    run = arm3r.Scenario.example("contact/energy_balance").run()
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        visitor.choose("contact/energy_balance")
        visitor.page.keyboard.press("End")
        visitor.settle()
        rows = visitor.page.locator("#energy-bars li").evaluate_all(
            "(all) => all.map((one) => { const bar = one.querySelector('i'); return [one.firstChild.textContent,"
            "Number(one.lastChild.textContent.replace('\u2212', '-')), getComputedStyle(bar).backgroundColor,"
            "bar.getBoundingClientRect().width, bar.parentElement.clientWidth]; })"
        )
        energies = {name: run[name] - (run[name][0] if name == "energy_potential" else 0) for name in ENERGIES}
        wanted = [(ENERGIES[name], values) for name, values in energies.items() if np.any(values)]
        assert [row[0] for row in rows] == [look[3] for look, _ in wanted]
        span = max(values.max() for _, values in wanted) - min(values.min() for _, values in wanted)
        for (label, value, colour, length, room), (look_of, values) in zip(rows, wanted, strict=True):
            assert value == pytest.approx(values[-1], abs=6e-3 * span), label
            assert length == pytest.approx(abs(values[-1]) / span * room, abs=0.5), label
            rgb = tuple(int(look_of[0][i : i + 2], 16) for i in (1, 3, 5))
            if look_of[0] != style.BLACK:  # which is lighter on the page
                assert colour == f"rgb{rgb}", label
        visitor.page.keyboard.press("b")
        visitor.settle()
        assert not visitor.page.is_visible("#energies")


def test_angles_are_in_degrees_or_radians(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        for unit, angle, label in (("°", "60.00", "q₃ 60.0°"), ("rad", "1.047", "q₃ 1.047 rad")):
            head = visitor.text_of('.plot[aria-label="Joint angles"] figcaption')
            assert head.startswith(f"Joint angles, {unit}") and angle in head, head
            assert label in visitor.page.locator(".scene-label").all_text_contents()
            if unit == "°":
                visitor.page.click("#views summary")
                visitor.page.click('[data-shown="degrees"]')
                visitor.settle()


# Those of all curves, px: window.dashes.
KEEP_DASHES = """window.dashes = new Set(); const set = CanvasRenderingContext2D.prototype.setLineDash;
CanvasRenderingContext2D.prototype.setLineDash = function (list) {
window.dashes.add(JSON.stringify(list.map((one) => one / devicePixelRatio))); return set.call(this, list); };
"""


def test_legends_have_the_dashes_of_the_figures(browser: Any, address: str) -> None:
    """Solid, dashed, dash-dotted for three of a kind; the curves are drawn with what the legend has."""
    strokes = "(all) => all.map((one) => one.getAttribute('stroke-dasharray').split(' ').filter(Boolean).map(Number))"
    with Visitor(browser, "laptop") as visitor:
        visitor.page.add_init_script(KEEP_DASHES)
        visitor.open(address)
        three = visitor.page.locator('.plot[aria-label="Torques"] .plot-line path').evaluate_all(strokes)
        assert [len(dash) for dash in three] == [{"-": 0, "--": 2, "-.": 4}[look_of["ls"]] for look_of in style.TRIPLE]
        dashes = [json.loads(text) for text in visitor.page.evaluate("() => [...window.dashes]")]
        assert all(dash in dashes for dash in three)


# ---- dragging -------------------------------------------------------------------------------------------------------


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
def test_the_tip_follows_the_pointer(browser: Any, address: str, size: str) -> None:
    """At any time of the run: the pose at the start becomes the one whose tip lies under the pointer."""
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        look(visitor, "side")
        visitor.page.keyboard.press("End")
        visitor.settle()
        before = tip_at_start(visitor)
        pointer = drag(visitor, "#tip-handle", (-60, -40))
        assert visitor.text_of("#time") == "0.000 s"
        assert np.abs(middle(visitor, "#tip-handle") - pointer).max() < 1
        tip = tip_at_start(visitor)
        assert tip[0] < before[0] - 0.1 and tip[2] > before[2] + 0.1 and abs(tip[1]) < 1e-6
        assert visitor.hash() == scenario(visitor).run().summary["hash"]
        visitor.check()


def test_the_tip_stays_within_reach(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        look(visitor, "side")
        drag(visitor, "#tip-handle", (90, -400))
        tip = tip_at_start(visitor)
        assert np.linalg.norm(tip) == pytest.approx(2, abs=2e-3) and tip[2] > 0.5
        box = visitor.page.locator("#scene").bounding_box()  # the picture follows when the pointer is released
        x, y = middle(visitor, "#tip-handle")
        assert 0 < x - box["x"] < box["width"] and 0 < y - box["y"] < box["height"]
        assert visitor.page.locator(".problem").count() == 0


def test_the_wall_follows_the_pointer_along_its_normal(browser: Any, address: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        look(visitor, "side")
        visitor.page.keyboard.press("End")
        visitor.settle()
        pointer = drag(visitor, "#wall-handle", (-50, 30))
        assert visitor.text_of("#time") == "10.000 s"
        assert abs(middle(visitor, "#wall-handle")[0] - pointer[0]) < 1
        x, y, z = scenario(visitor)["wall.point"]
        assert 1 < x < 1.95 and (y, z) == (0, 0)
        assert visitor.hash() == scenario(visitor).run().summary["hash"]
        visitor.check()


@pytest.mark.parametrize(("handle", "key"), [("#tip-handle", "initial.q"), ("#wall-handle", "wall.point")])
def test_a_slow_drag_is_undone_at_once(browser: Any, address: str, handle: str, key: str) -> None:
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        look(visitor, "side")
        before = scenario(visitor)
        drag(visitor, handle, (-60, -20), pause=800)
        dragged = scenario(visitor)
        assert dragged[key] != before[key]
        visitor.page.focus(handle)
        visitor.page.keyboard.press("Control+z")
        visitor.settle()
        assert scenario(visitor).to_yaml() == before.to_yaml()
        visitor.page.keyboard.press("Control+Shift+z")
        visitor.settle()
        assert scenario(visitor).to_yaml() == dragged.to_yaml()
        visitor.check()


def test_tip_and_wall_follow_a_finger(browser: Any, address: str) -> None:
    """And the page does not scroll under it."""
    with Visitor(browser, "phone", has_touch=True) as visitor:
        visitor.open(address)
        look(visitor, "side")
        before, scrolled = tip_at_start(visitor), visitor.page.evaluate("scrollY")
        pointer = drag_by_finger(visitor, "#tip-handle", (-30, -20))
        assert np.abs(middle(visitor, "#tip-handle") - pointer).max() < 1
        tip = tip_at_start(visitor)
        assert tip[0] < before[0] - 0.1 and tip[2] > before[2] + 0.1 and abs(tip[1]) < 1e-6
        pointer = drag_by_finger(visitor, "#wall-handle", (-15, 40))
        assert abs(middle(visitor, "#wall-handle")[0] - pointer[0]) < 1
        assert 1 < scenario(visitor)["wall.point"][0] < 1.99
        assert visitor.page.evaluate("scrollY") == scrolled
        assert visitor.hash() == scenario(visitor).run().summary["hash"]
        visitor.check()


@pytest.mark.sample(1)
@pytest.mark.parametrize("size", SIZES)
def test_tip_and_wall_are_moved_by_keys(browser: Any, address: str, size: str) -> None:
    with Visitor(browser, size) as visitor:
        visitor.open(address)
        look(visitor, "side")
        visitor.page.focus("#tip-handle")
        moves = {"ArrowLeft": (0, -1), "ArrowUp": (2, 1), "PageUp": (1, 1), "Shift+ArrowLeft": (0, -10)}
        for keys, (axis, steps) in moves.items():
            before = tip_at_start(visitor)
            visitor.page.focus("#tip-handle")
            visitor.page.keyboard.press(keys)
            visitor.settle()
            moved = tip_at_start(visitor) - before
            assert moved[axis] == pytest.approx(0.01 * steps, abs=1e-4), (keys, moved)
        assert re.match(r"Tip at the start: \d\.\d{3}, ", visitor.page.get_attribute("#tip-handle", "aria-label"))
        visitor.page.focus("#wall-handle")
        visitor.page.keyboard.press("Shift+ArrowRight")
        visitor.settle()
        assert visitor.page.get_attribute("#wall-handle", "aria-valuetext") == "2.100 m from the base at the start"
        assert scenario(visitor)["wall.point"] == [2.1, 0, 0]
        visitor.check()


@pytest.mark.gate
def test_the_main_thread_is_free_while_tip_and_wall_are_dragged(browser: Any, address: str) -> None:
    """As while a slider moves: at most 8 ms of a frame in 99 of 100, no task over 50 ms."""
    with Visitor(browser, "laptop") as visitor:
        visitor.open(address)
        look(visitor, "side")
        browser.start_tracing(page=visitor.page, categories=["toplevel", "devtools.timeline"])
        for selector in ("#tip-handle", "#wall-handle"):
            x, y = middle(visitor, selector)
            visitor.page.mouse.move(x, y)
            visitor.page.mouse.down()
            for step in range(60):
                visitor.page.mouse.move(x - step, y - step / 2)
                visitor.page.wait_for_timeout(15)
            visitor.page.mouse.up()
        visitor.settle()
        tasks, frames = tasks_of(json.loads(browser.stop_tracing()))
        visitor.check()
    most = percentile(frames, 0.99)
    print(f"\nmain thread, {len(frames)} frames: p99 {most:.2f} ms, longest task {max(tasks):.2f} ms")
    assert most <= 8 and max(tasks) <= 50
