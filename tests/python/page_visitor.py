"""A browser, the page that was built, and somebody who looks at it: for the tests of the live page."""

from __future__ import annotations

import math
import shutil
import threading
from collections.abc import Iterator
from typing import Any

import pytest
from arm3r_cpp.live import page as live_page
from arm3r_cpp.live import server
from parts import PAGE

SIZES = {"laptop": (1280, 800), "phone": (390, 844)}
FLAGS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]  # WebGL without a GPU
WAIT = 120_000  # ms, where other work keeps the machine busy
SETTLED = "body.started:not(.busy):not([data-drawing])"


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    program = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def address() -> str:
    """Of a server of the page that was built."""
    lines: list[str] = []
    live_page.FOLDER = PAGE  # of the repository: it need not be installed
    options = {"port": 0, "browser": False, "say": lines.append}
    threading.Thread(
        target=server.serve, args=(live_page.html("index.html", None),), kwargs=options, daemon=True
    ).start()
    while not lines:
        pass
    return lines[0].split()[0]


class Visitor:
    """Somebody who looks at a page, and keeps what went wrong."""

    def __init__(self, browser: Any, size: str, *, motion: bool = False, **options: Any) -> None:
        """motion: whether runs play by themselves; else the system asks for less motion."""
        width, height = SIZES[size]
        options["reduced_motion"] = "no-preference" if motion else "reduce"
        self.context = browser.new_context(viewport={"width": width, "height": height}, **options)
        self.page = self.context.new_page()
        self.page.set_default_timeout(WAIT)
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.page.on("console", lambda line: self.errors.append(line.text) if line.type == "error" else None)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))

    def open(self, address: str) -> Visitor:
        self.page.goto(address)
        self.settle()
        return self

    def settle(self) -> None:
        """Wait until the newest text has been simulated and drawn, and the present time is shown."""
        self.page.wait_for_selector(SETTLED, state="attached")
        self.page.evaluate(
            "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done())))"
        )

    def choose(self, name: str) -> None:
        self.page.click("#open-menu")
        self.page.click(f'.card[data-name="{name}"]')
        self.settle()

    def type_text(self, text: str) -> None:
        """Put a text in the place of the scenario, as somebody who pastes it."""
        self.page.click('[data-tab="text"]')
        self.page.click(".cm-content")
        self.page.keyboard.press("Control+a")
        self.page.keyboard.insert_text(text)
        self.settle()

    def text_of(self, selector: str) -> str:
        """With plain spaces."""
        return (self.page.text_content(selector) or "").replace("\u00a0", " ")

    def hash(self) -> str:
        """Of the run that is shown."""
        return self.text_of(".outcome code").strip()

    def set_slider(self, path: str, place: int) -> None:
        """Move a slider to a place of 0 to 1000, as a user does: it says input, then change."""
        move = (
            "(one, place) => { one.value = place;"
            "for (const kind of ['input', 'change']) one.dispatchEvent(new Event(kind)); }"
        )
        self.page.locator(f'input[type=range][data-path="{path}"]').evaluate(move, place)

    def check(self) -> None:
        assert self.errors == [], self.errors

    def __enter__(self) -> Visitor:
        return self

    def __exit__(self, *_: object) -> None:
        self.context.close()


def tasks_of(trace: dict[str, Any]) -> tuple[list[float], list[float]]:
    """Of the page's main thread, ms of the processor: each task, and all that begin within a frame's 1/60 s."""
    events = trace["traceEvents"]
    named = [e for e in events if e.get("name") == "thread_name" and e["args"].get("name") == "CrRendererMain"]
    threads = {(e["pid"], e["tid"]) for e in named}
    own = [e for e in events if (e["pid"], e["tid"]) in threads and "tdur" in e]
    tasks = [e for e in own if e["name"] == "ThreadControllerImpl::RunTask"]
    frames: dict[int, float] = {}
    for task in tasks:
        frame = int(task["ts"] * 60 / 1e6)
        frames[frame] = frames.get(frame, 0.0) + task["tdur"] / 1000
    return [task["tdur"] / 1000 for task in tasks], list(frames.values())


def percentile(values: list[float], share: float) -> float:
    return sorted(values)[min(len(values) - 1, math.ceil(share * len(values)) - 1)]
