"""The gallery of real robots: each against Pinocchio's numbers of its own file, and what its run must be."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache

import arm3r_cpp as arm3r
import numpy as np
import pytest
import yaml
from conftest import ROOT
from elbow_truth import Truth

GALLERY = ROOT / "scenarios" / "robots"
PAGE = (ROOT / "docs" / "own_arm.md").read_text()
NAMES = sorted(path.stem for path in GALLERY.glob("*.yaml"))
every_robot = pytest.mark.parametrize("name", NAMES)


@dataclass
class Start:
    """Pinocchio 4.1 at the start of a scenario, by buildReducedModel of the file that the scenario names.

    crba, computeGeneralizedGravity with g = 9.80665 m/s^2, and 1/(J M^-1 J^T) along x; without armature. The UR files
    write pi/2 as 1.570796327 and Kinova's writes 3.14159, which moves these numbers by up to 1e-9.
    """

    tip: tuple[float, ...]
    mass: tuple[float, ...]
    """M11, M12, M13, M22, M23, M33."""
    gravity: tuple[float, ...]
    along_x: float


PINOCCHIO = {
    "ur3_adaptive_reference": Start(
        (0.36708397749512206, 0.11234999998015263, 0.14048263186017862),
        (0.36345908915391334, -0.046397702052777365, 0.04510364133315211,
         0.34773607522208316, 0.13635272037624804, 0.18143436561791282),
        (0.0, -10.700881813541049, -4.9600713552035485), 2.690470095522623,
    ),
    "ur5_hybrid": Start(
        (0.5952809328134191, 0.10914999998495095, 0.11043635670333435),
        (1.4124337412278272, -0.20474228451266507, 0.09776063663265998,
         1.7639534558211714, 0.5216462607687127, 0.6873807448829209),
        (0.0, -31.395703385067563, -12.32289689981756), 4.2717463729318155,
    ),
    "ur10e_parallel": Start(
        (0.8607327014646518, 0.17414999998431532, 0.22407850657057),
        (5.111330805531087, -0.5592940607389788, 0.428309744762137,
         6.234932729791906, 2.0747798254124272, 2.650744107182949),
        (0.0, -71.97016462082577, -30.98986836961327), 7.768808988325822,
    ),
    "panda_impedance": Start(
        (0.6819586282061565, 0.0, 0.6831889061777807),
        (1.3985063611776725, -0.028035446149679604, -0.006447980474982472,
         2.4550076613616736, -1.1274256218053662, 0.9166859470023995),
        (0.0, -29.457784681559133, 22.15353712889105), 11.083942855846562,
    ),
    "iiwa_shaped_impedance": Start(
        (0.6724101615137754, 0.0, 0.48641016151377553),
        (2.954042451550448, 0.022886622807347767, 0.04313537740721276,
         3.758248994666085, -1.4167673791770845, 1.3531934551770843),
        (0.0, -58.52420748855261, 28.95130930861835), 11.722323318450103,
    ),
    "kinova_admittance": Start(
        (0.3634871425388595, -0.009800000003305854, 0.8366358131534826),
        (0.2643842349352803, 0.007093129714927114, 0.0002281039553402024,
         0.7332888143416134, -0.20496513930623883, 0.17184912976186426),
        (0.0, 8.08701387467404, -5.901029749148042), 2.3284302006699744,
    ),
    "puma_operational_space": Start(
        (0.5963031485746156, -0.15005, 0.657475732341913),
        (2.8742383613749993, -0.40405567408866927, 0.10091921973263308,
         2.0879795505, 0.35082247349999995, 0.3617793984999999),
        (0.0, 31.62080350241503, 6.0248048664252405), 3.0056315195635213,
    ),
}  # fmt: skip


@cache
def scenario_of(name: str) -> arm3r.Scenario:
    return arm3r.Scenario.load(GALLERY / f"{name}.yaml")


@cache
def run_of(name: str) -> arm3r.Run:
    return scenario_of(name).run()


def truth_of(name: str) -> Truth:
    return Truth(yaml.safe_load((GALLERY / f"{name}.yaml").read_text())["arm"])


def test_each_robot_has_its_own_law() -> None:
    assert {*NAMES} == {*PINOCCHIO}
    assert len({scenario_of(name)["controller.type"] for name in NAMES}) == len(NAMES) == 7


@every_robot
def test_the_head_names_source_licence_and_what_is_locked(name: str) -> None:
    head = " ".join(re.findall(r"^# (.*)", (GALLERY / f"{name}.yaml").read_text().partition("\nformat:")[0], re.M))
    assert re.search(r"github\.com/[\w-]+/[\w-]+", head) and re.search(r"BSD-[23]-Clause|Apache-2\.0|MIT", head)
    assert "Locked: " in head and "docs/model.md (7." in head


@every_robot
def test_the_arm_is_that_of_the_file(name: str) -> None:
    scenario, due = scenario_of(name), PINOCCHIO[name]
    q, armature = np.array(scenario["initial.q"]), np.diag(scenario["arm.armature"])
    mass = scenario.arm.mass_matrix(q) - armature
    assert abs(mass[np.triu_indices(3)] - due.mass).max() <= 1e-9 * mass.max()
    assert abs(scenario.arm.tip_position(q) - due.tip).max() <= 1e-9
    assert abs(scenario.arm.gravity_torque(q) - due.gravity).max() <= 1e-9 * abs(np.array(due.gravity)).max()
    without = scenario.copy()
    without["arm.armature"] = [0, 0, 0]
    assert without.arm.effective_mass(q, [1, 0, 0]) == pytest.approx(due.along_x, rel=1e-8)


@every_robot
def test_it_starts_clear_of_singular_poses_and_within_its_torques(name: str) -> None:
    scenario, run = scenario_of(name), run_of(name)
    assert np.linalg.cond(scenario.arm.jacobian(run["q"])).max() < 20
    assert (abs(run["tau"]) < 0.9 * np.array(scenario["arm.torque_limit"])).all()


@every_robot
def test_it_presses_as_its_checks_say(name: str) -> None:
    run = run_of(name)
    assert run.outcome == "ok" and run.passed and len(run.checks) >= 6
    assert run.summary["metrics"]["peak_force"] > 4


@every_robot
def test_a_fixed_fine_step_ends_where_the_adaptive_one_does(name: str) -> None:
    fixed = scenario_of(name).copy()
    fixed["solver"] = {"method": "rk4", "step": 5e-4, "events": "located"}
    one, other = run_of(name), fixed.run()
    assert other.passed
    assert abs(one["q"] - other["q"]).max() <= 1e-7
    assert abs(one["force"] - other["force"]).max() <= 1e-4


@every_robot
def test_every_row_obeys_an_independent_equation_of_motion(name: str) -> None:
    """The torque of a row is that of Newton and Euler in matrices, with the accelerations of its neighbours' rates."""
    scenario = scenario_of(name).copy()
    scenario.update({"time.log_every": 1e-3, "checks": []})
    run = scenario.run()
    rows = np.arange(10, len(run.t) - 10, 50)
    rows = rows[abs(np.diff(run["contact"], append=0)[rows[:, None] + np.arange(-4, 4)]).max(axis=1) == 0]
    acceleration = sum(
        weight * (run["qd"][rows + k] - run["qd"][rows - k]) / 1e-3
        for k, weight in ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))
    )
    due = truth_of(name).inverse_dynamics(run["q"][rows], run["qd"][rows], acceleration, run["f_on_tip"][rows])
    assert abs(run["tau"][rows] - due).max() <= 1e-5 * abs(due).max()


def test_a_tip_beside_the_plane_of_axis_1_loads_joint_1() -> None:
    """A UR5's tip is 109.15 mm beside it: 20 N along x are 2.183 N m there, where a planar arm has none."""
    assert run_of("ur5_hybrid")["tau1"][-1] == pytest.approx(-20 * 0.10915, abs=1e-6)


@every_robot
def test_the_page_says_what_the_run_shows(name: str) -> None:
    """Force and effective mass in the table of docs/own_arm.md."""
    scenario, run = scenario_of(name), run_of(name)
    row = re.search(rf"^\|.*\| `{scenario['controller.type']}` \| (.*) N.* \| (.*) kg \|$", PAGE, re.M)
    due = scenario.arm.effective_mass(scenario["initial.q"], [1, 0, 0])
    force = re.match(r"[\d.]+", row[1])[0]
    assert run["force"][-1] == pytest.approx(float(force), abs=0.06)
    assert due == pytest.approx(float(row[2]), abs=0.051)


def test_the_readme_begins_with_robots_and_arms_of_ones_own() -> None:
    first = "\n".join((ROOT / "README.md").read_text().splitlines()[:10])
    assert "(docs/own_arm.md)" in first and "UR5" in first
