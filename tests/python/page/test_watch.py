"""What the live page says of each scenario in one sentence is true: every number in it is that of the run."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from conftest import ROOT, scenario_files

pytestmark = pytest.mark.needs("wasm")

WASM = ROOT / "build" / "page" / "arm3r.wasm"
UNITS = {"ms": 1e-3, "mm": 1e-3, "µm": 1e-6}
N = r"(−?[\d.]+(?:e−?\d+)?)"  # as the page writes a number


def watched(*texts: str) -> list[dict[str, Any]]:
    command = ["node", str(ROOT / "tests" / "wasm" / "watch.mjs"), str(WASM)]
    done = subprocess.run(command, input=json.dumps(texts), capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


def whole(text: str) -> arm3r.Run:
    """The run, with all columns."""
    scenario = arm3r.Scenario(text).quiet()
    scenario["time.log_columns"] = None
    return scenario.run()


def times(run: arm3r.Run, kind: str) -> list[float]:
    return [event.t for event in run.events if event.type == kind]


def first_contact(run: arm3r.Run) -> float:
    return times(run, "make")[0]


def peak(run: arm3r.Run) -> float:
    return float(run.summary["peak_force"])


def most(run: arm3r.Run) -> float:
    return float(np.abs(run["force"]).max())


def final(name: str) -> Callable[[arm3r.Run], float]:
    return lambda run: float(run[name][-1])


def first(name: str) -> Callable[[arm3r.Run], float]:
    return lambda run: float(run[name][0])


def way(run: arm3r.Run) -> Any:
    """How far the tip is from where it was first, m."""
    return np.linalg.norm(run["tip"] - run["tip"][0], axis=1)


def length(run: arm3r.Run) -> float:
    return float(run.t[-1] - run.t[0])


def contact_lasts(run: arm3r.Run) -> float:
    begins = first_contact(run) if times(run, "make") else run.t[0]
    return float(times(run, "break")[-1] - begins)


def contacts(run: arm3r.Run) -> int:
    return len(times(run, "make")) + (run["contact"][0] > 0.5 and times(run, "make")[:1] != [run.t[0]])


DURATION = rf"{N} (m?s)"
FAR = rf"{N} ([mµ]?m)"
SINCE = rf" after the contact at {N} s"
STAYS = r"(, and the arm, which does not feel it, stays where it is)?"
WANTED = rf"(?:, where {N} N are wanted)?"
KINDS: dict[str, list[Callable[[arm3r.Run], float] | None]] = {
    rf"Watch the estimator of the wall's stiffness: in the end it finds {N} N/m\.": [final("stiffness_estimate")],
    rf"Watch the estimator of the wall's stiffness: in {DURATION} it finds none\.": [length, None],
    rf"Watch the energy in the tank: {N} J at first, {N} J in the end\.": [first("tank_energy"), final("tank_energy")],
    rf"Watch the tip bounce on the wall: it touches it (\d+) times, first at {N} s, with up to {N} N\.": [
        contacts, first_contact, peak],
    rf"Watch the tip bounce on the wall: it touches it (\d+) times, from the start, with up to {N} N\.": [
        contacts, peak],
    rf"Watch the contact at {N} s: it ends after {DURATION}, with up to {N} N\.": [
        first_contact, contact_lasts, None, peak],
    rf"Watch the contact: it ends after {DURATION}, with up to {N} N\.": [contact_lasts, None, peak],
    rf"Watch the pressing force{SINCE}: it peaks at {N} N and ends at {N} N{WANTED}{STAYS}\.": [
        first_contact, most, final("force"), final("force_ref"), None],
    rf"Watch the pressing force: it peaks at {N} N and ends at {N} N{WANTED}{STAYS}\.": [
        most, final("force"), final("force_ref"), None],
    rf"Watch the pressing force(?:{SINCE})?: it goes from {N} N at first to {N} N in the end{WANTED}{STAYS}\.": [
        None, most, final("force"), final("force_ref"), None],
    rf"Watch the pressing force{SINCE}: it grows to {N} N{WANTED}{STAYS}\.": [
        first_contact, final("force"), final("force_ref"), None],
    rf"Watch the pressing force: it (?:grows to|stays at) {N} N{WANTED}{STAYS}\.": [
        final("force"), final("force_ref"), None],
    rf"Watch that nothing moves: for {DURATION} the tip stays within {FAR}\.": [length, None, None, None],
    rf"Watch the tip fall: {FAR} in the first {DURATION}\.": [None, None, None, None],
    rf"Watch the tip: after {DURATION} it is {FAR} away from its start\.": [
        length, None, lambda run: float(way(run)[-1]), None],
    rf"Watch the tip: it moves up to {FAR} away from its start, at {N} s\.": [
        lambda run: float(way(run).max()), None, lambda run: float(run.t[way(run).argmax()])],
}  # fmt: skip


def number(text: str, unit: str | None) -> float:
    return float(text.replace("−", "-")) * UNITS.get(unit or "", 1)


def check(run: arm3r.Run, watch: dict[str, Any]) -> None:
    """The sentence has numbers, and all of them are right to their digits."""
    sentence = watch["sentence"]
    if joint := re.fullmatch(rf"Watch the observer's residual of joint (\d): it reaches {N} N m\.", sentence):
        residual = max(run["residual"][:, int(joint[1]) - 1], key=abs)
        assert number(joint[2], None) == pytest.approx(residual, rel=5.1e-3, abs=6e-5), sentence
        return
    [(found, truths)] = [(found, truths) for kind, truths in KINDS.items() if (found := re.fullmatch(kind, sentence))]
    groups = [*found.groups(), None]
    assert len(truths) == len(found.groups()), sentence
    for text, unit, truth in zip(groups, groups[1:], truths, strict=False):
        if text is None or truth is None:
            continue
        rounding = 6e-5 * UNITS.get(unit or "", 1)
        assert number(text, unit) == pytest.approx(truth(run), rel=5.1e-3, abs=rounding), sentence
    if "nothing moves" in sentence:
        assert way(run).max() <= number(*found.groups()[2:4]) and not run.events
    if "stays where it is" in sentence:
        assert way(run).max() < 1e-6
    if "grows" in sentence or "stays at" in sentence:
        assert run["force"].max() == pytest.approx(run["force"][-1], rel=5.1e-3)
    if " fall" in sentence:
        depth, depth_unit, after, after_unit = found.groups()
        fallen = np.interp(number(after, after_unit) + run.t[0], run.t, run["tip_z"][0] - run["tip_z"])
        assert fallen == pytest.approx(number(depth, depth_unit), rel=0.02)
        assert fallen > 0.97 * (run["tip_z"][0] - run["tip_z"].min())
    if "finds none" in sentence:
        assert not run["stiffness_estimate"][-1]


def test_each_sentence_is_true_of_its_scenario() -> None:
    texts = [path.read_text() for path in scenario_files()]
    for text, watch in zip(texts, watched(*texts), strict=True):
        run = whole(text)
        check(run, watch)
        assert watch["column"] in run.columns
        makes, breaks = times(run, "make"), times(run, "break")
        start = makes[0] if makes and (run["contact"][0] < 0.5 or makes[0] == run.t[0]) else run.t[0]
        assert watch["begins"] == start
        assert watch["begins"] <= watch["moment"] <= run.t[-1]
        ends = breaks[-1] if breaks and (not makes or breaks[-1] > makes[-1]) else run.t[-1]
        assert watch["lasts"] == pytest.approx(ends - start, abs=1e-12)


def test_the_sentence_follows_a_change() -> None:
    text = "format: 1\nwall: {contact: {stiffness: 2000}}\ncontroller: {type: gravity_compensation}\n"
    stiff, soft = watched(text, text.replace("2000", "500"))
    assert "grows to 464 N" in stiff["sentence"] and "grows to 116 N" in soft["sentence"]
    assert "stays where it is" in stiff["sentence"]


def test_a_fall_and_a_hold_are_told_apart() -> None:
    hold, fall = watched(
        "format: 1\ncontroller: {type: gravity_compensation}\ntime: {stop: 0.5}\n",
        "format: 1\ncontroller: {type: none}\ntime: {stop: 0.5}\n",
    )
    assert hold["sentence"] == "Watch that nothing moves: for 0.500 s the tip stays within 0.001 mm."
    assert fall["sentence"] == "Watch the tip fall: 1.07 m in the first 0.500 s."
