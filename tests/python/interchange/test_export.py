"""`arm3r export`: what Pinocchio and MuJoCo make of the files is what the scenario says."""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import mujoco
import numpy as np
import pinocchio as pin
import pytest
from arm3r_cpp.commands.interchange import export as export_cli
from exported import Numbers, by_mujoco, by_pinocchio, largest_difference

ARMS, LIMIT = 100, 1e-12


def random_link(rng: np.random.Generator) -> dict[str, Any]:
    """Of any shape, with or without numbers that replace those of the shape."""
    shape = str(rng.choice(["brick", "cylinder", "slender"]))
    link: dict[str, Any] = {"shape": shape, "length": rng.uniform(0.3, 1.2)}
    if shape == "brick":
        link |= {"section": rng.uniform(0.02, 0.2, 2).tolist(), "density": rng.uniform(500, 8000)}
    if shape == "cylinder":
        link |= {"radius": rng.uniform(0.02, 0.1), "density": rng.uniform(500, 8000)}
    if shape == "slender" or rng.random() < 0.5:
        link["mass"] = rng.uniform(0.3, 3)
    if rng.random() < 0.5:
        link["com"] = link["length"] * rng.uniform(0.1, 0.9)
    if rng.random() < 0.5:
        a, b, c = rng.uniform(0.005, 0.05, 3)
        link["inertia"] = [b + c, a + c, a + b]
    return link


def random_column(rng: np.random.Generator) -> dict[str, Any]:
    if rng.random() < 0.5:
        return {"mass": rng.uniform(0.3, 3), "com": rng.uniform(-0.5, 0.5), "inertia_axial": rng.uniform(0, 0.5)}
    return {"shape": "cylinder", "length": rng.uniform(0.2, 1), "radius": rng.uniform(0.05, 0.2)}


def random_scenario(rng: np.random.Generator) -> arm3r.Scenario:
    scenario = arm3r.Scenario()
    scenario["arm"] = {
        "convention": str(rng.choice(["simscape", "slide"])),
        "base_height": rng.uniform(-1, 1),
        "gravity": rng.uniform(-10, 10, 3),
        "link1": random_column(rng),
        "link2": random_link(rng),
        "link3": random_link(rng),
        "payload": {"mass": rng.uniform(0.1, 2)},
        "armature": rng.uniform(0, 0.1, 3),
        "damping": rng.uniform(0, 0.5, 3),
        "torque_limit": rng.uniform(1, 9, 3),
    }
    return scenario


def numbers_of(scenario: arm3r.Scenario, q: np.ndarray) -> Numbers:
    arm = scenario.arm
    return Numbers(arm.tip_position(q), arm.jacobian(q), arm.mass_matrix(q), arm.gravity_torque(q))


def text_of(scenario: arm3r.Scenario, path: Path) -> str:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", arm3r.ScenarioWarning)
        arm3r.export(scenario, path)
    return path.read_text(encoding="utf-8")


@pytest.mark.parametrize("seed", range(ARMS))
def test_other_programs_compute_the_same_arm(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    scenario, q = random_scenario(rng), rng.uniform(-4, 4, 3)
    ours = numbers_of(scenario, q)
    assert largest_difference(ours, by_mujoco(text_of(scenario, tmp_path / "arm.xml"), q)) <= LIMIT
    theirs = by_pinocchio(text_of(scenario, tmp_path / "arm.urdf"), scenario["arm.gravity"], q)
    rotors = np.diag(scenario["arm.armature"])
    assert largest_difference(ours, theirs._replace(mass_matrix=theirs.mass_matrix + rotors)) <= LIMIT


def test_the_centres_of_mass_are_those_of_the_links(tmp_path: Path) -> None:
    """That of link 1 has no effect on the motion."""
    for seed in range(10):
        scenario = random_scenario(np.random.default_rng(seed))
        model, data = started(text_of(scenario, tmp_path / "arm.xml"))
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.xipos[1:4], scenario.arm.centres(data.qpos), atol=1e-14)


def test_mujoco_reads_the_urdf_too(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    scenario, q = random_scenario(rng), np.array([0.7, -0.4, 1.1])
    scenario["arm.armature"] = [0, 0, 0]
    model = mujoco.MjModel.from_xml_string(text_of(scenario, tmp_path / "arm.urdf"))
    model.opt.gravity = scenario["arm.gravity"]
    data = mujoco.MjData(model)
    data.qpos = q
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qfrc_bias, scenario.arm.gravity_torque(q), rtol=1e-12, atol=1e-12)


def test_the_motion_is_the_same_with_damping_and_limited_motors(tmp_path: Path) -> None:
    scenario = random_scenario(np.random.default_rng(2))
    scenario.update({"initial": {"q": [0.3, -0.5, 0.9], "qd": [0.2, 0.1, -0.3]}, "time.stop": 1})
    scenario["arm.torque_limit"] = [2, 3, np.inf]
    scenario["controller"] = {"type": "constant", "torque": [5, -7, 1]}
    model, data = started(text_of(scenario, tmp_path / "arm.xml"))
    data.ctrl = [5, -7, 1]
    assert farthest(model, data, scenario) <= 1e-9


# ---- the wall -------------------------------------------------------------------------------------------------------

ARM = {
    "base_height": 0.2,
    "gravity": [0, 0, -9.80665],
    "link2": {"length": 0.8, "mass": 2},
    "link3": {"length": 0.6, "mass": 1.2},
    "payload": {"mass": 0.3},
    "armature": [0.02, 0.03, 0.01],
}


def started(text: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def farthest(model: mujoco.MjModel, data: mujoco.MjData, scenario: arm3r.Scenario) -> float:
    """The largest difference of an angle from arm3r's run, over its rows, rad."""
    run, worst = scenario.run(), 0.0
    assert run["t"][0] == data.time
    for t, q in zip(run["t"], run["q"], strict=True):
        while data.time < t - model.opt.timestep / 2:
            mujoco.mj_step(model, data)
        worst = max(worst, float(np.abs(data.qpos - q).max()))
    return worst


def walled(**wall: Any) -> arm3r.Scenario:
    """A wall that meets an arm at rest, whose weight is compensated, obliquely."""
    scenario = arm3r.Scenario()
    scenario.update({"arm": ARM, "initial.q": [0.4, -0.5, 1.0], "controller": {"type": "gravity_compensation"}})
    scenario.update({"time": {"start": 0.5, "stop": 3}, "solver": {"rtol": 1e-11, "atol": 1e-13}})
    tip, normal = scenario.arm.tip_position(scenario["initial.q"]), np.array([-1, -0.3, 0.1])
    normal /= np.linalg.norm(normal)
    keys = {"point": tip - 0.11 * normal, "normal": normal, "face_offset": 0.02, "size": "infinite"}
    scenario["wall"] = {**keys, "acts_on_arm": True, **wall}
    return scenario


def with_compensated_weight(text: str) -> str:
    return text.replace("<body ", '<body gravcomp="1" ')


def test_a_moving_wall_pushes_the_arm_to_the_same_place(tmp_path: Path) -> None:
    for velocity, control in ((0.05, -7), ([-0.06, -0.1, 0.1], 7)):
        scenario = walled(motion={"type": "constant", "velocity": velocity})
        model, data = started(with_compensated_weight(text_of(scenario, tmp_path / "wall.xml")))
        data.ctrl[3] = control  # the wall moves whatever it is
        assert farthest(model, data, scenario) <= 1e-6
        assert np.abs(data.qpos - scenario["initial.q"]).max() > 0.02


def test_the_lectures_wall_moves_the_same_way(tmp_path: Path) -> None:
    scenario = arm3r.Scenario.example("moving_wall")
    scenario.update({"checks": None, "wall.size": "infinite", "wall.acts_on_arm": True, "time.log_every": 0.05})
    model, data = started(with_compensated_weight(text_of(scenario, tmp_path / "wall.xml")))
    assert farthest(model, data, scenario) <= 1e-7


def test_a_falling_arm_bounces_off_a_fixed_wall(tmp_path: Path) -> None:
    scenario = walled(motion={"type": "fixed"}, point=[0, 0, -0.2], normal=[0.1, 0.2, 1])
    scenario.update({"controller": {"type": "none"}, "time": {"start": 0, "stop": 1, "log_every": 0.01}})
    assert scenario.run().summary["peak_force"] > 1
    model, data = started(text_of(scenario, tmp_path / "wall.xml"))
    assert farthest(model, data, scenario) <= 2e-6


@pytest.mark.parametrize(
    "key, value, said",
    [
        ("wall.contact", {"law": "kelvin_voigt", "damping": 3}, "wall.contact.law: kelvin_voigt; it must be spring"),
        ("wall.contact", {"friction": {"coefficient": 0.3}}, "wall.contact.friction.coefficient: 0.3; it must be 0"),
        ("wall.size", [1, 2], "wall.size: [1, 2]; it must be infinite"),
        ("wall.motion", {"type": "sinusoid", "amplitude": 0.1, "frequency": 1}, "wall.motion.type: sinusoid; it must"),
        ("wall.rotation", {"type": "constant", "axis": [0, 0, 1], "rate": 0.1}, "wall.rotation.type: constant; it m"),
    ],
)
def test_a_wall_that_mujoco_cannot_have_is_refused_by_name(key: str, value: Any, said: str, tmp_path: Path) -> None:
    scenario, path = walled(), tmp_path / "wall.xml"
    arm3r.export(scenario, path)
    before = path.read_text()
    scenario[key] = value
    with pytest.raises(arm3r.UsageError, match="leave the wall out by --set wall=null") as caught:
        arm3r.export(scenario, path)
    assert said in str(caught.value) and path.read_text() == before
    arm3r.export(scenario, tmp_path / "arm.urdf")


def test_a_wall_that_does_not_act_is_left_out_with_a_warning(tmp_path: Path) -> None:
    with pytest.warns(arm3r.ScenarioWarning, match="the wall is left out"):
        arm3r.export(arm3r.Scenario.example("moving_wall"), tmp_path / "arm.xml")
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "arm.xml")).nu == 3


# ---- what a format cannot have --------------------------------------------------------------------------------------


def test_what_is_left_out_is_said_in_the_file_and_by_a_warning(tmp_path: Path) -> None:
    scenario = arm3r.Scenario()
    scenario.update({"arm.armature": [0.02, 0, 0], "arm.friction": [0.1, 0, 0], "push": {"force": [1, 0, 0]}})
    with pytest.warns(arm3r.ScenarioWarning, match="URDF has no armature: arm.armature 0.02 0 0"):
        arm3r.export(scenario, tmp_path / "arm.urdf")
    assert "<!-- URDF has no armature: arm.armature 0.02 0 0" in (tmp_path / "arm.urdf").read_text()
    with pytest.warns(arm3r.ScenarioWarning) as caught:
        arm3r.export(scenario, tmp_path / "arm.xml")
    said = "\n".join(str(one.message) for one in caught)
    assert "frictionloss" in said and "push" in said and "armature" not in said


def test_limits_and_friction_are_in_both_files(tmp_path: Path) -> None:
    scenario = arm3r.Scenario()
    limits, damping, friction = [3, 0, np.inf], [0.1, 0, 0.3], [0, 0.2, 0.4]
    scenario.update({"arm.torque_limit": limits, "arm.damping": damping, "arm.friction": friction})
    robot = pin.buildModelFromXML(text_of(scenario, tmp_path / "arm.urdf"))
    assert robot.upperEffortLimit.tolist() == [3, 0, 1e9]
    assert (robot.damping.tolist(), robot.friction.tolist()) == (damping, friction)
    model, data = started(text_of(scenario, tmp_path / "arm.xml"))
    assert (model.dof_damping.tolist(), model.dof_frictionloss.tolist()) == (damping, friction)
    data.ctrl = [5, 5, 5]
    mujoco.mj_forward(model, data)
    assert data.qfrc_actuator.tolist() == [3, 0, 5]


# ---- the file -------------------------------------------------------------------------------------------------------

HOSTILE = """a"><x> & '--> <!-- ]]> <![CDATA[ ü"""


def test_a_hostile_name_stays_a_name(tmp_path: Path) -> None:
    scenario = arm3r.Scenario()
    scenario["name"] = HOSTILE
    robot = ElementTree.fromstring(text_of(scenario, tmp_path / "arm.urdf"))
    assert robot.get("name") == HOSTILE
    assert [child.get("name") for child in robot.findall("link")] == ["base", "link1", "link2", "link3", "tip"]
    root = ElementTree.fromstring(text_of(scenario, tmp_path / "arm.xml"))
    assert root.get("model") == HOSTILE and mujoco.MjModel.from_xml_path(str(tmp_path / "arm.xml")).nq == 3


def test_the_command_writes_the_file_or_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "s.yaml"
    source.write_text("format: 1\n")

    def called(*words: object) -> tuple[int, str]:
        return export_cli.main(list(map(str, [source, *words]))), capsys.readouterr().err

    assert called("-o", tmp_path / "a.urdf", "--set", "arm.payload.mass=0.5") == (0, "")
    assert '<mass value="0.5" />' in (tmp_path / "a.urdf").read_text()
    for name in ("a.sdf", "a", "a.URDF"):
        code, said = called("-o", tmp_path / name)
        assert code == 2 and ".urdf or .xml is written there" in said and not (tmp_path / name).is_file()
    assert called("-o", tmp_path / "none" / "a.xml")[0] == 6
    assert called("-o", tmp_path / "b.xml", "--set", "arm.payload.mass=-1")[0] == 3
    source.write_text("format: 1\nwall: {acts_on_arm: true}\n")
    code, said = called("-o", tmp_path / "b.xml")
    assert code == 2 and f"{source}: MuJoCo cannot have: wall.size" in said and len(said.splitlines()) == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.urdf", "s.yaml"]
