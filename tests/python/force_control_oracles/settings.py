"""The scenario of every benchmark item as plain data: start, wall, law with its gains, memory at the start, end."""

from __future__ import annotations

from typing import Any

import numpy as np

from .arm import Arm

QA = np.deg2rad([0.0, 30.0, -60.0]).tolist()
XA = [float(np.sqrt(3.0)), 0.0, 0.0]
SPEED = 0.05
F_D = 20.0
LECTURE_CONTACT = (2 - np.sqrt(3.0)) / SPEED

Setting = dict[str, Any]


def varied(setting: Setting, **changes: Any) -> Setting:
    """The setting with some keys changed; maps are merged, but those of another law or controller replaced."""
    new = dict(setting)
    for key, value in changes.items():
        merged = isinstance(value, dict) and key in new and not {"type", "law"} & value.keys()
        new[key] = varied(new[key], **value) if merged else value
    return new


def spring_wall(x: float, k: float, speed: float = 0.0) -> Setting:
    return {"point": [x, 0, 0], "normal": [-1, 0, 0], "speed": speed, "contact": {"law": "spring", "k": k}}


def tip_at(x: float, y: float, z: float, elbow: int = -1) -> list[float]:
    return Arm().reach([x, y, z], elbow).tolist()


PRESSED = XA[0] - F_D / 5000
LECTURE_WALL = spring_wall(2.0, 5000.0, SPEED)

OBSERVED_PD = {"type": "joint_pd", "Kp": [400, 400, 200], "Kd": [60, 60, 25], "q_d": QA}
HYBRID = {"type": "hybrid", "f_d": F_D, "kP": 0.5, "kI": 5.0, "m_f": 1.0, "b": 70.0, "K": 400.0, "D": 40.0, "x_d": XA}
ADMITTANCE = {"type": "admittance", "M": 2.0, "B": 40.0, "K": 200.0, "w": 50.0, "zeta": 1.0}
AHEAD = [XA[0] + 0.05, 0.0, 0.0]
PUSH = [-10.0, 4.0, 3.0]
UNSTABLE_POSE = np.deg2rad([0.0, -75.0, 45.0]).tolist()
UNSTABLE_TIP = Arm().at(UNSTABLE_POSE).x.tolist()
TURNED_START = [0.1, *QA[1:]]
OBLIQUE_NORMAL = [-float(np.cos(0.3)), -float(np.sin(0.3)), 0.0]
SWING = {"amplitude": 0.02, "frequency": 1.0}

ENERGY_BALANCE: Setting = {
    "arm": {"armature": [0.02, 0.02, 0.01], "viscous": [0.2, 0.3, 0.1], "coulomb": [0.1, 0.2, 0.05], "eps": 1e-2},
    "q": TURNED_START,
    "wall": {
        "point": (Arm().at(TURNED_START).x + 0.005 * np.array(OBLIQUE_NORMAL)).tolist(),
        "normal": OBLIQUE_NORMAL,
        "sinusoid": SWING,
        "contact": {"law": "kelvin_voigt", "k": 2e4, "c": 20.0, "friction": 0.3, "slip": 1e-3},
    },
    "controller": {"type": "joint_pd", "Kp": [200, 200, 100], "Kd": [20, 20, 8], "q_d": TURNED_START},
    "stop": 2.0,
}
JOINT_PD_SAG: Setting = {
    "q": QA,
    "controller": {"type": "joint_pd", "Kp": [200, 200, 100], "Kd": [30, 30, 10], "q_d": QA, "gravity": False},
    "stop": 12.0,
}
COMPUTED_TORQUE: Setting = {
    "q": (np.array(QA) - [0.3, -0.2, 0.4]).tolist(),
    "controller": {"type": "computed_torque", "Kp": 100.0, "Kd": 20.0, "q_d": QA},
    "stop": 0.5,
}
COMPUTED_TORQUE_PUSH: Setting = {
    "q": QA,
    "controller": {"type": "computed_torque", "Kp": 100.0, "Kd": 20.0, "q_d": QA, "cancel": False},
    "push": PUSH,
    "stop": 4.0,
}
STIFFNESS_FIXED_WALL: Setting = {
    "q": QA,
    "wall": spring_wall(1.70, 5000.0),
    "controller": {"type": "cartesian_stiffness", "K_P": 500.0, "K_D": 100.0, "x_d": [1.75, 0.0, 0.0]},
    "stop": 6.0,
}
STIFFNESS_MOVING_WALL = varied(STIFFNESS_FIXED_WALL, wall=LECTURE_WALL, controller={"x_d": XA}, start=5.3, stop=12.0)
JOINT_STIFFNESS: dict[str, Setting] = {
    f"joint stiffness {mm} mm": {
        "q": tip_at(1.70 + mm / 1000, 0, 0),
        "wall": spring_wall(1.70, 5000.0),
        "controller": {"type": "joint_stiffness", "K_P": 500.0, "K_D": 100.0, "q_d": tip_at(1.70 + mm / 1000, 0, 0)},
        "stop": 6.0,
    }
    for mm in (50.0, 5.0, 0.5)
}
SHAPED_IMPEDANCE_STEP: Setting = {
    "q": QA,
    "wall": spring_wall(XA[0], 1000.0),
    "controller": {"type": "impedance", "M": 2.0, "B": 40.0, "K": 200.0, "x_d": AHEAD},
    "stop": 2.0,
}
IMPEDANCE_STEP = varied(
    SHAPED_IMPEDANCE_STEP, controller={"type": "cartesian_stiffness", "K_P": 200.0, "K_D": 40.0, "x_d": AHEAD}
)


def admittance_near_balance(k: float) -> Setting:
    """The tip 1e-4 m deeper than where it balances, x_c at the balance, all at rest."""
    balance = XA[0] + 200.0 * 0.05 / (200.0 + k)
    return {
        "q": tip_at(balance + 1e-4, 0, 0),
        "wall": spring_wall(XA[0], k),
        "controller": ADMITTANCE | {"x_d": AHEAD},
        "memory": [balance, 0, 0, 0, 0, 0],
        "stop": 6.0,
    }


HYBRID_MOVING_WALL: Setting = {
    "q": QA,
    "wall": spring_wall(PRESSED, 5000.0, SPEED),
    "controller": HYBRID,
    "memory": [0.0],
    "stop": 3.0,
}
HYBRID_FIRST_CONTACT: Setting = {
    "q": QA,
    "wall": LECTURE_WALL,
    "controller": {"type": "hold_tip", "K": 400.0, "D": 40.0, "x_d": XA},
    "after contact": {"controller": HYBRID, "memory": [0.0]},
    "stop": 12.0,
}
PARALLEL_FIXED_WALL: Setting = {
    "q": QA,
    "wall": spring_wall(PRESSED, 5000.0),
    "controller": {
        "type": "parallel", "f_d": F_D, "m": 1.0, "K_D": 80.0, "K_P": 100.0, "K_F": 0.5, "K_I": 6.0,
        "x_d": [XA[0], 0.1, -0.05],
    },
    "memory": [0.0],
    "stop": 12.0,
}  # fmt: skip
WRONG_STIFFNESS: Setting = {
    "q": QA,
    "wall": spring_wall(XA[0], 5000.0),
    "controller": {"type": "impedance", "M": 2.0, "B": 100.0, "K": 500.0},
    "stop": 2.0,
}
OBSERVER_FORCE_STEP: Setting = {
    "q": QA,
    "controller": {"type": "constant", "torque": (Arm().at(QA).gravity - Arm().at(QA).J.T @ PUSH).tolist()},
    "observer": {"K_O": 50.0},
    "memory": [0.0, 0.0, 0.0],
    "push": PUSH,
    "stop": 0.1,
}
OBSERVER_MOVING_WALL: Setting = {
    "q": QA,
    "wall": spring_wall(2.0, 2000.0, SPEED),
    "controller": OBSERVED_PD,
    "observer": {"K_O": 50.0},
    "memory": [0.0, 0.0, 0.0],
    "start": 5.3,
    "stop": 8.0,
}
REACTIONS: dict[str, Setting] = {
    "ignore": {"memory": None},
    "stop": {"memory": None, "controller": OBSERVED_PD | {"q_d": None}},
    "float": {"memory": None, "controller": {"type": "gravity_compensation"}},
    "reflex": {
        "memory": None,
        "controller": {"type": "gravity_compensation"},
        "observer": {"K_O": 50.0, "yielding": 1.0},
    },
}
REFLEX: Setting = {
    "q": QA,
    "controller": {"type": "gravity_compensation"},
    "observer": {"K_O": 50.0, "yielding": 0.0},
    "memory": [0.0, 0.0, 0.0],
    "push": [-0.01, 0.0, 0.0],
    "stop": 0.2,
}
SAMPLING_PERIOD: Setting = {
    "arm": {"gravity": [0.0, 0.0, 0.0]},
    "q": (np.array(QA) + 1e-7).tolist(),
    "controller": {"type": "computed_torque", "Kp": 400.0, "Kd": 40.0, "q_d": QA},
    "period": 0.049,
    "ticks": 60,
}
FORCE_DELAY: Setting = {
    "q": tip_at(XA[0] + 1e-6, 0, 0),
    "wall": spring_wall(PRESSED, 5000.0),
    "controller": HYBRID,
    "memory": [0.0],
    "delay": 0.95 * 0.024826254913580644,
    "stop": 2.5,
}
INSTABILITY: Setting = {
    "q": tip_at(UNSTABLE_TIP[0] + 1e-6, 0, UNSTABLE_TIP[2], elbow=1),
    "controller": {"type": "hybrid_joints", "Kp": 25.0, "Kv": 10.0, "x_d": UNSTABLE_TIP, "position": [1, 0, 0]},
    "stop": 1.0,
}
VARIABLE_STIFFNESS_TANK: Setting = {
    "q": tip_at(XA[0] + 0.010, 0.005, 0.010),
    "controller": {
        "type": "tank", "K_0": 200.0, "swing": [120.0, 6.25], "D": 0.3, "x_d": XA,
        "E_lo": 0.01, "E_hi": 0.03, "E_max": 5.0,
    },
    "memory": [0.05],
    "stop": 2.0,
}  # fmt: skip

SETTINGS: dict[str, Setting] = {
    "energy balance": ENERGY_BALANCE,
    "energy balance, two contact modes": varied(ENERGY_BALANCE, modes=2),
    "restitution": {
        "q": QA,
        "wall": varied(LECTURE_WALL, contact={"law": "hunt_crossley", "k": 1e7, "p": 1.5, "beta": 6.0}),
        "controller": {"type": "gravity_compensation"},
        "start": 5.3,
        "stop": 5.4,
    },
    "joint PD sag": JOINT_PD_SAG,
    "joint PD with gravity compensation": varied(JOINT_PD_SAG, q=[0.1, 0.4, -0.9], controller={"gravity": True}),
    "computed torque": COMPUTED_TORQUE,
    "computed torque push": COMPUTED_TORQUE_PUSH,
    "stiffness fixed wall": STIFFNESS_FIXED_WALL,
    "stiffness moving wall": STIFFNESS_MOVING_WALL,
    **JOINT_STIFFNESS,
    "shaped impedance step": SHAPED_IMPEDANCE_STEP,
    "impedance step": IMPEDANCE_STEP,
    "admittance below the limit": admittance_near_balance(1396.8),
    "admittance above the limit": admittance_near_balance(1483.2),
    "admittance soft wall": admittance_near_balance(200.0),
    "hybrid moving wall": HYBRID_MOVING_WALL,
    "hybrid moving wall, kI 0": varied(HYBRID_MOVING_WALL, controller={"kI": 0.0}),
    "hybrid first contact": HYBRID_FIRST_CONTACT,
    "hybrid first contact, kI 0": varied(HYBRID_FIRST_CONTACT, **{"after contact": {"controller": {"kI": 0.0}}}),
    "hybrid biased sensor": varied(HYBRID_MOVING_WALL, wall={"speed": 0.0}, controller={"bias": 1.5}),
    "hybrid Jacobian transpose": varied(
        HYBRID_MOVING_WALL,
        controller={
            "type": "hybrid_transposed",
            "f_d": F_D,
            "kP": 1.0,
            "kI": 20.0,
            "b": 70.0,
            "K": 400.0,
            "D": 40.0,
            "x_d": XA,
        },
        stop=4.0,
    ),
    "parallel fixed wall": PARALLEL_FIXED_WALL,
    "parallel moving wall": varied(PARALLEL_FIXED_WALL, wall={"speed": SPEED}),
    "adaptive reference moving wall": {
        "q": QA,
        "wall": spring_wall(PRESSED, 5000.0, SPEED),
        "controller": {
            "type": "seeking",
            "f_d": F_D,
            "k_r": 0.02,
            "M": 2.0,
            "B": 80.0,
            "K": 200.0,
            "x_r": [XA[0] + 0.1, 0.0, 0.0],
        },
        "memory": [0.0],
        "stop": 6.0,
    },
    "wall stiffness estimate": varied(HYBRID_MOVING_WALL, controller={"dither": [2.0, 2.0]}),
    "wall stiffness not identifiable": HYBRID_MOVING_WALL,
    "wall stiffness overestimated": varied(
        WRONG_STIFFNESS, controller={"x_d": [XA[0] + F_D / 6000 + F_D / 500, 0.0, 0.0]}
    ),
    "wall stiffness underestimated": varied(
        WRONG_STIFFNESS, controller={"x_d": [XA[0] + F_D / 4000 + F_D / 500, 0.0, 0.0]}
    ),
    "observer force step": OBSERVER_FORCE_STEP,
    "observer force step by a wall": varied(
        OBSERVER_FORCE_STEP,
        push=[0.0, 0.0, 0.0],
        wall={
            "point": (np.array(XA) + np.array(PUSH) / 1000).tolist(),
            "normal": (np.array(PUSH) / np.linalg.norm(PUSH)).tolist(),
            "speed": 0.0,
            "contact": {"law": "spring", "k": 1000.0},
        },
    ),
    "observer moving wall": OBSERVER_MOVING_WALL,
    "reflex K_R 0": REFLEX,
    "reflex K_R 1": varied(REFLEX, observer={"yielding": 1.0}),
    "reflex K_R 3": varied(REFLEX, observer={"yielding": 3.0}),
    **{
        f"reaction {name}": varied(
            OBSERVER_MOVING_WALL,
            threshold=0.5,
            start=LECTURE_CONTACT,
            stop=LECTURE_CONTACT + 1,
            **{"after detection": then},
        )
        for name, then in REACTIONS.items()
    },
    "sampling period zeta 1": SAMPLING_PERIOD,
    "sampling period zeta 0.3": varied(SAMPLING_PERIOD, controller={"Kd": 12.0}, period=0.98 * 0.06),
    "force delay below the margin": FORCE_DELAY,
    "force delay above the margin": varied(FORCE_DELAY, delay=1.05 * 0.024826254913580644),
    "instability raibert_craig": INSTABILITY,
    "instability projected": varied(INSTABILITY, controller={"projected": True}),
    "instability dynamic": varied(
        INSTABILITY, controller={"type": "hold_tip", "K": 25.0, "D": 10.0, "x_d": UNSTABLE_TIP, "selected": [1, 0, 0]}
    ),
    "variable stiffness tank": VARIABLE_STIFFNESS_TANK,
    "stiff damping": varied(STIFFNESS_MOVING_WALL, start=LECTURE_CONTACT, stop=LECTURE_CONTACT + 0.4),
    "variable stiffness no tank": varied(VARIABLE_STIFFNESS_TANK, controller={"bounded": False}),
}
