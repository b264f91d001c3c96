"""Arms of textbooks and libraries as elbow arms, against the numbers or the formulas that are printed there."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from elbow_arms import arm_of, roll_pitch_yaw
from elbow_truth import Truth
from random_scenarios import Keys

# ---- Siciliano, Sciavicco, Villani, Oriolo: Robotics, section 7.3.2 --------------------------------------------------

SICILIANO = {"a": 1.0, "l": 0.5, "m_l": 50.0, "I_l": 10.0, "k_r": 100.0, "m_m": 5.0, "I_m": 0.01}
"""Both links and both motors of his two-link planar arm; motor 2 sits on link 1 at joint 2."""


def siciliano_arm() -> Keys:
    """Joints 2 and 3 are his; joint 1 is the wall on which his arm hangs in its plane."""
    n = SICILIANO
    link = {"mass": n["m_l"], "com": [n["l"], 0, 0], "inertia": [0.1, n["I_l"], n["I_l"], 0, 0, 0]}
    rotor = {"inertia": n["I_m"], "ratio": n["k_r"], "mass": n["m_m"]}
    return {
        "model": "elbow",
        "convention": "slide",
        "link2": {"length": n["a"], **link},
        "link3": {"tip": [n["a"], 0, 0], **link},
        "rotor2": rotor,
        "rotor3": rotor,
        "armature": [1, 0, 0],
        "gravity": [0, 0, -9.81],
    }


def siciliano(theta: np.ndarray, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """His B, C qd and g (7.82 to 7.88 of the English edition)."""
    a, l, m_l, I_l, k_r, m_m, I_m = SICILIANO.values()  # noqa: E741
    c2, s2, gravity = np.cos(theta[1]), np.sin(theta[1]), 9.81
    b11 = I_l + m_l * l**2 + k_r**2 * I_m + I_l + m_l * (a**2 + l**2 + 2 * a * l * c2) + I_m + m_m * a**2
    b12 = I_l + m_l * (l**2 + a * l * c2) + k_r * I_m
    b22 = I_l + m_l * l**2 + k_r**2 * I_m
    h = -m_l * a * l * s2
    C = np.array([[h * rates[1], h * (rates[0] + rates[1])], [-h * rates[0], 0]])
    c1, c12 = np.cos(theta[0]), np.cos(theta[0] + theta[1])
    g = [(m_l * l + m_m * a + m_l * a) * gravity * c1 + m_l * l * gravity * c12, m_l * l * gravity * c12]
    return np.array([[b11, b12], [b12, b22]]), C @ rates, np.array(g)


def test_a_two_link_arm_with_motors_is_sicilianos() -> None:
    """His B has k_r I_m off its diagonal and k_r^2 I_m on it, where armature alone has no coupling."""
    arm, rng = arm_of(siciliano_arm()), np.random.default_rng(8)
    for _ in range(20):
        theta, rates = rng.uniform(-3, 3, 2), rng.uniform(-3, 3, 2)
        q, qd = np.array([0.4, *theta]), np.array([0.0, *rates])
        B, C_qd, g = siciliano(theta, rates)
        assert abs(arm.mass_matrix(q)[1:, 1:] - B).max() <= 1e-13 * abs(B).max()
        assert abs(arm.velocity_product(q, qd)[1:] - C_qd).max() <= 1e-13 * max(abs(C_qd).max(), 100)
        assert abs(arm.gravity_torque(q)[1:] - g).max() <= 1e-13 * 1000
    assert B[0, 1] - B[1, 1] == pytest.approx(50 * 0.5 * np.cos(theta[1]) + (100 - 100**2) * 0.01)


def test_a_motor_that_spins_against_its_joint_pulls_the_other_way() -> None:
    """The coupling changes its sign with that of the ratio, all else stays."""
    keys = siciliano_arm()
    other = {**keys, "rotor3": {**keys["rotor3"], "ratio": -100.0}}
    q = np.array([0.4, 0.3, -0.8])
    change = arm_of(keys).mass_matrix(q) - arm_of(other).mass_matrix(q)
    due = np.zeros((3, 3))
    due[1, 2] = due[2, 1] = 2 * 100 * 0.01
    assert abs(change - due).max() <= 1e-12 * 300


# ---- Lynch, Park: Modern Robotics, the examples of its library -------------------------------------------------------

M_LIST = [
    [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.089159], [0, 0, 0, 1]],
    [[0, 0, 1, 0.28], [0, 1, 0, 0.13585], [-1, 0, 0, 0], [0, 0, 0, 1]],
    [[1, 0, 0, 0], [0, 1, 0, -0.1197], [0, 0, 1, 0.395], [0, 0, 0, 1]],
    [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.14225], [0, 0, 0, 1]],
]
"""Each frame in the one before: base, three centres of mass, end-effector"""
G_LIST = [
    ([0.010267, 0.010267, 0.00666], 3.7),
    ([0.22689, 0.22689, 0.0151074], 8.393),
    ([0.0494433, 0.0494433, 0.004095], 2.275),
]
"""Principal inertias and masses"""
S_LIST = [[1, 0, 1, 0, 1, 0], [0, 1, 0, -0.089, 0, 0], [0, 1, 0, -0.089, 0, 0.425]]
"""Screw axes: the first one is sqrt(2) long, so that its joint turns by sqrt(2) for each unit of its variable."""
LEVEL = np.column_stack([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
"""Links 2 and 3 at home: x along x, z along the axes of their joints, y"""
SCALE = np.array([np.sqrt(2), 1, 1])

THETA, RATES, ACCELERATIONS = np.array([0.1, 0.1, 0.1]), np.array([0.1, 0.2, 0.3]), np.array([2, 1.5, 1])


def lynch_park_arm() -> Keys:
    """Axes 2 and 3 lie along y; axis 1, along (1, 0, 1), passes them at 0.644 m."""
    k, v = np.array([1, 0, 1]) / np.sqrt(2), np.array([0.0, 1, 0])
    u = np.cross(v, k)
    on_first, second, third = np.array([0, 0, 1.0]), np.array([0, 0, 0.089]), np.array([0.425, 0, 0.089])
    for screw, point in zip(S_LIST, (on_first, second, third), strict=True):
        assert np.allclose(screw[3:], np.cross(point, screw[:3]))
    position = on_first + k * (k @ (second - on_first))
    homes = [np.eye(4)]
    for M in M_LIST:
        homes.append(homes[-1] @ np.array(M, float))
    frames = [(np.column_stack([u, v, k]), position), (LEVEL, second), (LEVEL, third)]
    links = []
    for (R, origin), home, (principal, mass) in zip(frames, homes[1:], G_LIST, strict=False):
        turned = R.T @ home[:3, :3]
        tensor = turned @ np.diag(principal) @ turned.T
        entries = [float(tensor[i]) for i in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]]
        links.append({"mass": mass, "com": (R.T @ (home[:3, 3] - origin)).tolist(), "inertia": entries})
    return {
        "model": "elbow",
        "convention": "urdf",
        "joint_sign": [1, -1, -1],
        "joint_zero": [0, float(np.arctan2(k[0], u[0])), 0],
        "base": {"position": position.tolist(), "rotation": roll_pitch_yaw(frames[0][0])},
        "shoulder_offset": float(u @ (second - position)),
        "link1": links[0],
        "link2": {"length": 0.425, **links[1]},
        "link3": {"tip": (LEVEL.T @ (homes[4][:3, 3] - third)).tolist(), **links[2]},
        "gravity": [0, 0, -9.8],
    }


def test_the_example_of_modern_robotics_has_its_printed_numbers() -> None:
    """Those of MassMatrix, VelQuadraticForces, GravityForces, EndEffectorForces, Inverse- and ForwardDynamics."""
    keys = lynch_park_arm()
    arm, q, qd = arm_of(keys), SCALE * THETA, SCALE * RATES
    M = np.array(
        [
            [2.25433380e01, -3.07146754e-01, -7.18426391e-03],
            [-3.07146754e-01, 1.96850717e00, 4.32157368e-01],
            [-7.18426391e-03, 4.32157368e-01, 1.91630858e-01],
        ]
    )
    assert np.allclose(SCALE[:, None] * arm.mass_matrix(q) * SCALE, M, rtol=0, atol=1e-7)
    assert np.allclose(SCALE * arm.velocity_product(q, qd), [0.26453118, -0.05505157, -0.00689132], rtol=0, atol=1e-8)
    assert np.allclose(SCALE * arm.gravity_torque(q), [28.40331262, -37.64094817, -5.4415892], rtol=0, atol=1e-7)

    home = np.linalg.multi_dot([np.array(step, float) for step in M_LIST])[:3, :3]
    tip_axes = Truth(keys).frame_rotation(q, 3) @ LEVEL.T @ home
    wrench = np.concatenate([tip_axes @ np.ones(3)] * 2)  # force and moment of ones, that the tip exerts
    by_wrench = SCALE * (arm.geometric_jacobian(q).T @ wrench)
    assert np.allclose(by_wrench, [1.40954608, 1.85771497, 1.392409], rtol=0, atol=1e-8)
    torque = SCALE * arm.inverse_dynamics(q, qd, SCALE * ACCELERATIONS) + by_wrench
    assert np.allclose(torque, [74.69616155, -33.06766016, -3.23057314], rtol=0, atol=1e-7)
    inner = np.array([0.5, 0.6, 0.7]) - by_wrench
    acceleration = arm.forward_dynamics(q, qd, inner / SCALE) / SCALE
    assert np.allclose(acceleration, [-0.97392907, 25.58466784, -32.91499212], rtol=0, atol=1e-6)


# ---- PUMA 560: Corke's link data -------------------------------------------------------------------------------------

PUMA_MOTORS = {"inertia": [200e-6] * 3, "ratio": [-62.6111, 107.815, -53.7063]}
FOLDED = np.array([0, np.pi / 4, np.pi, 0, np.pi / 4, 0])
"""his pose qn, rad"""


def puma_chain(wrist: np.ndarray) -> tuple[list[dict[str, float]], np.ndarray]:
    """The rows of his table, and how each link after the third lies in the frame of the third."""
    path = Path(__file__).parents[1] / "robots" / "puma560.csv"
    lines = [line for line in path.read_text().splitlines() if line and line != "standard" and not line.startswith("#")]
    rows = []
    for row in csv.DictReader(lines):
        quarter = {"0": 0.0, "pi/2": np.pi / 2, "-pi/2": -np.pi / 2}[row.pop("alpha")]
        rows.append({"alpha": quarter, **{key: float(value) for key, value in row.items() if key != "type"}})
    poses = [np.eye(4)]
    for row, angle in zip(rows[3:], wrist, strict=True):
        c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(row["alpha"]), np.sin(row["alpha"])
        step = [[c, -s * ca, s * sa, row["a"] * c], [s, c * ca, -c * sa, row["a"] * s], [0, sa, ca, row["d"]]]
        poses.append(poses[-1] @ np.array([*step, [0, 0, 0, 1]]))
    return rows, np.array(poses)


def puma_arm(wrist: np.ndarray) -> Keys:
    """With the wrist locked: links 3 to 6 are one body. The motors count by their armature, as he has it."""
    rows, poses = puma_chain(wrist)

    def body(row: dict[str, float]) -> tuple[float, np.ndarray, np.ndarray]:
        centre = np.array([row["cx"], row["cy"], row["cz"]])
        return row["mass"], centre, np.diag([row["Ixx"], row["Iyy"], row["Izz"]])

    quarter = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # Rx(-pi/2): frame 3 of the table in that of link 3
    shift = np.array([rows[2]["a"], 0, rows[2]["d"]])
    masses, centres, tensors = [], [], []
    for row, pose in zip(rows[2:], poses, strict=True):
        mass, centre, tensor = body(row)
        R = quarter @ pose[:3, :3]
        masses.append(mass)
        centres.append(shift + quarter @ pose[:3, 3] + R @ centre)
        tensors.append(R @ tensor @ R.T)
    total, centre = sum(masses), np.average(centres, axis=0, weights=masses)
    inertia = sum(
        tensor + mass * ((c - centre) @ (c - centre) * np.eye(3) - np.outer(c - centre, c - centre))
        for mass, c, tensor in zip(masses, centres, tensors, strict=True)
    )
    upper_mass, upper_centre, upper_tensor = body(rows[1])
    length = rows[1]["a"]
    entries = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
    tip = shift + quarter @ poses[-1][:3, 3]
    return {
        "model": "elbow",
        "convention": "slide",
        "link1": {"inertia": [0, 0, 0.35, 0, 0, 0]},  # its axis of the table is y
        "link2": {
            "length": length,
            "mass": upper_mass,
            "com": (upper_centre + np.array([length, 0, 0])).tolist(),
            "inertia": [float(upper_tensor[i]) for i in entries],
        },
        "link3": {
            "tip": tip.tolist(),
            "mass": float(total),
            "com": centre.tolist(),
            "inertia": [float(inertia[i]) for i in entries],
        },
        "armature": [200e-6 * ratio**2 for ratio in PUMA_MOTORS["ratio"]],
        "gravity": [0, 0, -9.81],
    }


def test_a_puma_has_the_inertia_and_the_weight_that_corke_prints() -> None:
    """Robotics, Vision and Control, 9.2: four digits are printed. Locking the wrist leaves the first three columns."""
    arm, q = arm_of(puma_arm(FOLDED[3:])), FOLDED[:3]
    M = [[3.6594, -0.4044, 0.1006], [-0.4044, 4.4137, 0.3509], [0.1006, 0.3509, 0.9378]]
    assert abs(arm.mass_matrix(q) - M).max() <= 6e-5
    assert abs(arm.gravity_torque(q) - [0, 31.6399, 6.0351]).max() <= 6e-5


@pytest.mark.parametrize(
    ("pose", "weight"), [([0, 0, -np.pi / 2], [0, 46.0069, 8.7722]), ([0, np.pi / 2, -np.pi / 2], [0, -0.7752, 0.2489])]
)
def test_a_puma_weighs_what_corke_prints_stretched_and_upright(pose: list[float], weight: list[float]) -> None:
    assert abs(arm_of(puma_arm(np.zeros(3))).gravity_torque(pose) - weight).max() <= 6e-5


def test_the_motors_of_a_puma_as_rotors_are_armature_where_they_spin_with_no_other_axis() -> None:
    """A rotor on the base couples with nothing; those of joints 2 and 3 do as their formula says, here along link 2."""
    keys = puma_arm(FOLDED[3:])
    armature = np.array(keys["armature"])
    plain = {**keys, "armature": [0, 0, 0]}
    inertia, ratio = PUMA_MOTORS["inertia"], PUMA_MOTORS["ratio"]
    turning = {f"rotor{j + 1}": {"inertia": inertia[j], "ratio": ratio[j]} for j in range(3)}
    turning["rotor3"]["axis"] = [1, 0, 0]
    q = FOLDED[:3]
    change = arm_of({**plain, **turning}).mass_matrix(q) - arm_of(plain).mass_matrix(q)
    along = np.sin(q[1])  # how much joint 1 turns link 2 about its own x
    due = np.diag(armature)
    due[0, 2] = due[2, 0] = inertia[2] * ratio[2] * along
    due[0, 0] += inertia[2] * along**2
    assert abs(change - due).max() <= 1e-14 * 5
