"""Stiff contact: how many steps each method takes, and that they agree."""

from __future__ import annotations

import math

import arm3r_cpp as arm3r
import pytest

MASS = 0.5535415113  # kg, along the normal
CASES = {  # contact, steps allowed: twice those of LSODA, and of an explicit pair of order 5
    "spring 1e4": ({"law": "spring", "stiffness": 1e4}, 2 * 144, 2 * 78),
    "spring 1e6": ({"law": "spring", "stiffness": 1e6}, 2 * 1307, 2 * 415),
    "spring 1e7": ({"law": "spring", "stiffness": 1e7}, 2 * 4157, 2.05 * 1128),
    "damped 1e7, zeta 1": ({"law": "kelvin_voigt", "stiffness": 1e7, "zeta": 1}, 2 * 250, 2 * 1084),
    "damped 1e7, zeta 10": ({"law": "kelvin_voigt", "stiffness": 1e7, "zeta": 10}, 2 * 205, 2 * 10230),
    "rubbing": ({"law": "kelvin_voigt", "stiffness": 1e5, "zeta": 1, "rubs": True}, 2 * 296, 2 * 128571),
}


def _run(contact: dict, method: str, *, rtol: float = 1e-6) -> arm3r.Run:
    contact = dict(contact)
    zeta, rubs = contact.pop("zeta", None), contact.pop("rubs", False)
    if zeta is not None:
        contact["damping"] = 2 * zeta * math.sqrt(contact["stiffness"] * MASS)
    if rubs:
        contact["friction"] = {"coefficient": 0.5, "slip_velocity": 1e-5}
    scenario = arm3r.Scenario("format: 1\narm: {convention: slide}\nwall: {acts_on_arm: true, size: infinite}\n")
    scenario["wall.point"] = [1.7320508075688772, 0, 0]
    scenario["wall.contact"] = contact
    scenario["controller"] = {"type": "stiffness"}
    scenario["solver"] = {"method": method, "rtol": rtol, "atol": rtol * 1e-3}
    scenario["time.stop"] = 0.4
    return scenario.run()


def _steps(run: arm3r.Run) -> int:
    return run.summary["steps"]["accepted"] + run.summary["steps"]["rejected"]


@pytest.mark.parametrize("case", CASES)
def test_auto_takes_few_steps_everywhere(case: str) -> None:
    contact, most, _ = CASES[case]
    run = _run(contact, "auto")
    assert _steps(run) <= most
    assert run.summary["energy_residual_max"] <= 1e-7


@pytest.mark.parametrize("case", [case for case in CASES if case != "rubbing"])
def test_the_explicit_method_takes_what_such_methods_take(case: str) -> None:
    contact, _, most = CASES[case]
    run = _run(contact, "dopri5")
    assert _steps(run) <= most
    assert run.summary["energy_residual_max"] <= 1e-7


@pytest.mark.parametrize("case", ["spring 1e6", "damped 1e7, zeta 1", "damped 1e7, zeta 10"])
def test_the_methods_agree(case: str) -> None:
    contact = CASES[case][0]
    tight = _run(contact, "dopri5", rtol=1e-10)
    for method in ("rodas4", "auto"):
        run = _run(contact, method, rtol=1e-8)
        assert run.summary["peak_force"] == pytest.approx(tight.summary["peak_force"], rel=1e-5)
        assert run["tip"][-1] == pytest.approx(tight["tip"][-1], abs=1e-7)


def test_the_summary_says_what_auto_did_and_why() -> None:
    stiff = _run(CASES["damped 1e7, zeta 10"][0], "auto").summary["solver"]
    assert stiff["method"] == "auto" and stiff["stiff_steps"] > 90
    assert "rodas4 from t = " in stiff["choices"] and "h*lambda stood above" in stiff["choices"]
    assert "dopri5 throughout" in _run(CASES["spring 1e6"][0], "auto").summary["solver"]["choices"]
    assert _run(CASES["spring 1e4"][0], "dopri5").summary["solver"]["choices"] == ""
