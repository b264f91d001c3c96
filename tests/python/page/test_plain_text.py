"""The text with which the live page opens a recorded run: short, angles in degrees, and the run to the last bit."""

from __future__ import annotations

import re

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp.live.plain_text import in_degrees, plain_text
from conftest import scenario_files


@pytest.mark.parametrize("path", scenario_files(), ids=lambda path: path.stem)
def test_the_text_means_the_same_and_is_shorter(path: object) -> None:
    whole = arm3r.Scenario.load(path).to_yaml()
    plain = plain_text(whole)
    assert arm3r.Scenario(plain).to_yaml() == whole
    assert len(plain) < len(whole)


def test_what_is_not_said_is_not_there() -> None:
    """As a run of the lecture's wall once opened: `inertia_axial: 1.3083333333333334e-5`, and angles of 16 digits."""
    text = plain_text(arm3r.Scenario.example("moving_wall").to_yaml())
    settings = text.partition("checks:")[0]
    assert settings.startswith("format: 1\nname: moving-wall\nwall: {}\ncontroller:\n  type: gravity_compensation\n")
    assert not re.search(r"\d{12}|inertia", settings)


def test_angles_are_in_degrees() -> None:
    scenario = arm3r.Scenario("format: 1\ninitial: {q: [20 deg, -50 deg, 75.5 deg], qd: [0.1, 0, 0.2]}\n")
    text = plain_text(scenario.to_yaml())
    assert "  q: [20 deg, -50 deg, 75.5 deg]\n  qd: [0.1, 0, 0.2]\n" in text


@pytest.mark.parametrize(
    ("value", "degrees"),
    [
        ("[0, -0.5235987755982988, 1.0471975511965976]", "[0 deg, -30 deg, 60 deg]"),
        ("0.3490658503988659", "20 deg"),
        ("[0.1, 0.2]", ""),
        ("1.3083333333333334e-5", ""),
        ("spring", ""),
        ("ur10e_1.0471975511965976", ""),
        ("", ""),
    ],
)
def test_what_is_an_angle(value: str, degrees: str) -> None:
    assert in_degrees(value) == degrees
