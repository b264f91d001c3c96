"""Keys of elbow arms: what is refused, of what is warned, and what is left out without harm."""

from __future__ import annotations

import copy
import warnings
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from elbow_arms import WITH_OFFSETS, arm_of, joint_angles, scenario_of, told_in
from elbow_truth import Truth
from random_scenarios import Keys

Q, QD, TAU = np.array([0.3, -0.6, 1.2]), np.array([0.5, -0.4, 0.7]), np.array([3.0, -5.0, 2.0])


def changed(arm: Keys, path: str, value: Any = None) -> Keys:
    """The arm with another value at this path; without the key where there is no value."""
    other = copy.deepcopy(arm)
    *sections, key = path.split(".")
    place = other
    for section in sections:
        place = place.setdefault(section, {})
    if value is None:
        place.pop(key)
    else:
        place[key] = value
    return other


def words_of_refusal(arm: Keys) -> str:
    with pytest.raises(arm3r.ScenarioError) as raised:
        scenario_of(arm).validate()
    return str(raised.value)


def warnings_of(arm: Keys) -> list[str]:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scenario_of(arm).validate()
    return [str(one.message) for one in told if issubclass(one.category, arm3r.ScenarioWarning)]


# ---- refused ---------------------------------------------------------------------------------------------------------

PLANAR: Keys = {"link2": {"length": 1, "mass": 1, "com": 0.5, "inertia": [0.01, 0.1, 0.1]}}
ROTOR: Keys = {"inertia": 1e-4, "ratio": 50, "axis": [0, 0, 1]}

REFUSED: list[tuple[str, Any, str]] = [
    ("link2.mass", None, "link2.mass"),
    ("link2.com", None, "link2.com"),
    ("link2.inertia", None, "link2.inertia"),
    ("link2.length", None, "link2.length"),
    ("link3.tip", None, "link3.tip"),
    ("link3.mass", None, "link3.mass"),
    ("link2.mass", -1.0, "link2.mass"),
    ("link1.mass", -0.1, "link1.mass"),
    ("payload.mass", -0.1, "payload.mass"),
    ("link2.inertia", [-0.1, 0.2, 0.2, 0, 0, 0], "link2.inertia"),
    ("link2.inertia", [0.1, 0.2, 0.2], "link2.inertia"),
    ("link2.com", 0.5, "link2.com"),
    ("link2.com", [0.5, 0.1], "link2.com"),
    ("link2.length", 0, "link2.length"),
    ("link2.length", -0.4, "link2.length"),
    ("link3.tip", [0, 0, 0.3], "link3.tip"),  # on the axis of joint 3: singular everywhere
    ("link3.tip", 0.4, "link3.tip"),
    ("link3.length", 0.4, "link3.length"),
    ("link2.shape", "brick", "link2.shape"),
    ("link1.inertia_axial", 0.1, "link1.inertia_axial"),
    ("base_height", 0.3, "base_height"),
    ("base.position", [0, 0], "base.position"),
    ("base.rotation", [0, 0, 0, 1], "base.rotation"),
    ("base.height", 0.3, "base.height"),
    ("joint_sign", [1, -1, -1], "joint_sign"),  # with urdf only
    ("joint_zero", [0, 0, 0], "joint_zero"),
    ("rotor2", {**ROTOR, "inertia": -1e-4}, "rotor2.inertia"),
    ("rotor2", {**ROTOR, "mass": -1}, "rotor2.mass"),
    ("rotor2", {**ROTOR, "axis": [0, 0, 0]}, "rotor2.axis"),
    ("rotor4", ROTOR, "rotor4"),
    ("model", "ellbow", "arm.model"),
    ("model", "planar", "shoulder_offset"),
]


@pytest.mark.parametrize(("path", "value", "named"), REFUSED, ids=str)
def test_what_no_elbow_arm_has_is_refused_by_name(path: str, value: Any, named: str) -> None:
    assert named in words_of_refusal(changed(WITH_OFFSETS, path, value))


@pytest.mark.parametrize("sign", [[1, 2, -1], [0, 1, 1], [1, 1, 0.5], [1, -1]], ids=str)
def test_a_sign_is_one_or_minus_one(sign: list[float]) -> None:
    arm = told_in(WITH_OFFSETS, "urdf")
    assert "joint_sign" in words_of_refusal({**arm, "joint_sign": sign})


def test_a_planar_arm_has_no_signs_and_zeros_of_its_own() -> None:
    assert "convention" in words_of_refusal({**PLANAR, "convention": "urdf"})
    for key, value in {"shoulder_offset": 0.1, "rotor2": ROTOR, "base": {"position": [0, 0, 1]}}.items():
        assert key in words_of_refusal({**PLANAR, key: value})


def test_an_arm_without_mass_about_axis_1_is_refused() -> None:
    """Two slender links in the plane of axis 1 have no inertia about it where both are upright."""
    slender = {"mass": 1.0, "com": [0.3, 0, 0], "inertia": [0, 0.05, 0.05, 0, 0, 0]}
    arm = {"model": "elbow", "link2": {"length": 0.6, **slender}, "link3": {"tip": [0.6, 0, 0], **slender}}
    words_of_refusal(arm)
    words_of_refusal({**arm, "armature": [0, 0.1, 0.1]})
    scenario_of({**arm, "armature": [0.1, 0, 0]}).validate()
    scenario_of({**arm, "shoulder_offset": 0.2}).validate()


def test_an_arm_whose_elbow_has_no_inertia_is_refused() -> None:
    """A point mass on the axis of joint 3 turns without effort."""
    last = {"tip": [0.4, 0, 0], "mass": 1.0, "com": [0, 0, 0], "inertia": [0, 0, 0, 0, 0, 0]}
    arm = {**WITH_OFFSETS, "link3": last, "armature": [0.1, 0.1, 0]}
    words_of_refusal(arm)
    scenario_of({**arm, "payload": {"mass": 0.2}}).validate()


# ---- warned ----------------------------------------------------------------------------------------------------------


def test_a_tensor_that_no_body_has_is_warned_of() -> None:
    """Not refused: link 3 of Corke's PUMA is so. Products of inertia may be too large for the diagonal, too."""
    for link, inertia in (("link3", [0.066, 0.086, 0.0125, 0, 0, 0]), ("link2", [0.3, 0.3, 0.3, 0.29, 0, 0])):
        told = warnings_of(changed(WITH_OFFSETS, f"{link}.inertia", inertia))
        assert any(f"{link}.inertia" in text for text in told), (link, told)
    assert not [text for text in warnings_of(WITH_OFFSETS) if "inertia" in text]


# ---- left out --------------------------------------------------------------------------------------------------------

DEFAULTS: dict[str, Any] = {
    "base": {"position": [0, 0, 0], "rotation": [0, 0, 0]},
    "shoulder_offset": 0,
    "link1": {"mass": 0, "com": [0, 0, 0], "inertia": [0, 0, 0, 0, 0, 0]},
}


def test_what_is_left_out_is_zero() -> None:
    short = copy.deepcopy({key: value for key, value in WITH_OFFSETS.items() if key not in DEFAULTS})
    del short["link2"]["offset"]
    there, here = {**copy.deepcopy(short), **DEFAULTS}, short
    there["link2"]["offset"] = 0
    assert np.array_equal(arm_of(there).params, arm_of(here).params, equal_nan=True)
    assert np.array_equal(arm_of(there).mass_matrix(Q), arm_of(here).mass_matrix(Q))


@pytest.mark.parametrize("joint", [1, 2, 3])
@pytest.mark.parametrize("convention", ["slide", "simscape", "urdf"])
def test_a_rotor_spins_along_its_joint_unless_told_otherwise(joint: int, convention: str) -> None:
    arm = told_in(WITH_OFFSETS, convention, sign=[-1, 1, -1], zero=[0.2, -0.4, 0.7])
    signs = {"slide": [1, 1, 1], "simscape": [1, -1, -1], "urdf": [-1, 1, -1]}[convention]
    axis = [[0, 0, signs[0]], [0, -signs[1], 0], [0, 0, signs[1] * signs[2]]][joint - 1]
    rotor = {"inertia": 2e-4, "ratio": 70.0, "mass": 0.3}
    plain, told = ({**arm, f"rotor{joint}": rotor}, {**arm, f"rotor{joint}": {**rotor, "axis": axis}})
    assert np.array_equal(arm_of(plain).mass_matrix(Q), arm_of(told).mass_matrix(Q))
    longer = {**arm, f"rotor{joint}": {**rotor, "axis": [2.5 * part for part in axis]}}
    assert np.allclose(arm_of(longer).mass_matrix(Q), arm_of(told).mass_matrix(Q), rtol=1e-15)


def test_armature_and_rotors_add_up() -> None:
    """ratio^2 inertia beside the armature; on joint 1 there is nothing else, for the base stands."""
    arm = {**WITH_OFFSETS, "rotor1": {"inertia": 2e-4, "ratio": 70.0, "mass": 3.0}}
    more = arm_of(arm).mass_matrix(Q) - arm_of(WITH_OFFSETS).mass_matrix(Q)
    due = np.zeros((3, 3))
    due[0, 0] = 2e-4 * 70.0**2
    assert abs(more - due).max() <= 1e-14


def test_a_rotor_on_the_base_weighs_on_no_joint() -> None:
    arm = {**WITH_OFFSETS, "rotor1": {"inertia": 2e-4, "ratio": 70.0, "mass": 3.0}}
    assert np.array_equal(arm_of(arm).gravity_torque(Q), arm_of(WITH_OFFSETS).gravity_torque(Q))


def test_angles_may_have_units() -> None:
    base = {"position": [0.1, -0.2, 0.3], "rotation": ["30 deg", "-45 deg", "90 deg"]}
    due = {**base, "rotation": np.deg2rad([30, -45, 90]).tolist()}
    here, there = (arm_of({**WITH_OFFSETS, "base": one}) for one in (base, due))
    assert np.allclose(here.tip_position(Q), there.tip_position(Q), rtol=0, atol=1e-15)
    arm = told_in(WITH_OFFSETS, "urdf", sign=[1, -1, 1], zero=np.deg2rad([10, -20, 30]))
    assert np.allclose(
        arm_of({**arm, "joint_zero": ["10 deg", "-20 deg", "30 deg"]}).tip_position(Q), arm_of(arm).tip_position(Q)
    )


def test_a_joint_zero_is_the_inner_angle_where_the_joint_reads_zero() -> None:
    """theta = s q + o: it shifts angles alone, neither rates nor torques."""
    zero = np.array([0.4, -0.7, 1.1])
    arm = told_in(WITH_OFFSETS, "urdf", sign=[-1, 1, -1], zero=zero)
    slide = told_in(WITH_OFFSETS, "slide")
    assert abs(arm_of(arm).tip_position([0, 0, 0]) - arm_of(slide).tip_position(zero)).max() <= 1e-14
    q = joint_angles(arm, Q)
    ways = np.array([-1, 1, -1])
    ours = ways * arm_of(arm).forward_dynamics(q, ways * QD, ways * TAU)
    assert np.allclose(ours, arm_of(slide).forward_dynamics(Q, QD, TAU), rtol=1e-12)


# ---- changed in a scenario -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("shoulder_offset", -0.12),
        ("base.position", [0.4, 0.5, -0.6]),
        ("base.rotation", [1.0, -0.5, 2.0]),
        ("link2.offset", -0.2),
        ("link3.tip", [0.3, -0.2, 0.25]),
        ("link1.com", [0.1, 0.2, 0.3]),
        ("link3.inertia", [0.02, 0.06, 0.07, 0.004, -0.003, 0.002]),
        ("rotor3", {"inertia": 2e-4, "ratio": 70.0, "mass": 0.3, "axis": [1, 1, 0]}),
    ],
    ids=lambda part: part if isinstance(part, str) else "",
)
def test_a_key_that_is_set_counts(path: str, value: Any) -> None:
    scenario = scenario_of(WITH_OFFSETS)
    scenario[f"arm.{path}"] = value
    truth = Truth(changed(WITH_OFFSETS, path, value))
    assert abs(scenario.arm.tip_position(Q) - truth.tip_position(Q)).max() <= 1e-13
    M = truth.mass_matrix(Q)
    assert abs(scenario.arm.mass_matrix(Q) - M).max() <= 1e-14 * abs(M).max()
    assert abs(scenario.arm.gravity_torque(Q) - truth.gravity_torque(Q)).max() <= 1e-12 * 100


def test_the_reference_reaches_no_pose_inside_the_cylinder() -> None:
    """A law that is sent there is refused or ends in a named outcome; where neither happens its numbers are right."""
    inside = np.array(WITH_OFFSETS["base"]["position"])
    scenario = scenario_of(
        WITH_OFFSETS,
        initial={"q": joint_angles(WITH_OFFSETS, [0.5, 0.7, -1.3]).tolist()},
        controller={"type": "resolved_acceleration"},
        reference={"type": "point", "tip": inside.tolist()},
        time={"stop": 1.0},
    )
    try:
        run = scenario.run()
    except arm3r.Arm3rError as error:
        assert str(error)
        return
    assert np.isfinite(run["q"]).all()
    assert abs(run["energy_residual"]).max() <= 1e-3 * (1 + abs(run["work_actuators"]).max())


# ---- sentences of an arm with offsets --------------------------------------------------------------------------------


def test_a_straight_elbow_is_told_by_its_bend() -> None:
    """q3 is no measure of it: the joint zero is the arm's own."""
    arm = changed(WITH_OFFSETS, "link3.tip", [0.3, 0.0, 0.05])
    scenario = scenario_of(
        arm, initial={"q": joint_angles(arm, [0.5, 0.7, 0.0]).tolist()}, controller={"type": "hybrid"}
    )
    with pytest.raises(arm3r.ScenarioError) as raised:
        scenario.validate()
    words = str(raised.value)
    assert "the elbow is straight or folded, got the sine of the bend = " in words
    assert "sin(q3)" not in words


def test_lengths_in_millimetres_are_warned_of_by_the_keys_that_hold_them() -> None:
    for key, value, sentence in (
        ("link2.length", 425.0, "link2.length is 425 m; was it given in millimetres?"),
        ("link3.tip", [392.0, 0, 0], "link3.tip is 392 m from joint 3; was it given in millimetres?"),
    ):
        told = [message for message in warnings_of(changed(WITH_OFFSETS, key, value)) if "millimetres" in message]
        assert len(told) == 1
        assert sentence in told[0]
