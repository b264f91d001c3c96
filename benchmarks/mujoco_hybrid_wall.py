"""hybrid_wall.yaml as one would write it with MuJoCo's Python API: python mujoco_hybrid_wall.py OUT.csv

10 s in steps of 1 ms by RK4. Before each the law of docs/model.md (7.13) gives a torque from MuJoCo's mass matrix, bias
and Jacobians, and the wall a penalty force; both are held over the step, where ours lets the wall's act at every stage.
Motion, torques, tip, force and energies in every one of 10 001 rows. Prints where the time went as JSON.
"""

from __future__ import annotations

import json
import sys
import time

begun = time.perf_counter()
import mujoco  # noqa: E402
import numpy as np  # noqa: E402
from mujoco_rows import write  # noqa: E402
from peer_arms import MJCF, STIFFNESS, WALL_FAR, WALL_SPEED  # noqa: E402

VECTORS = ["q", "qd", "qdd", "tau", "tip", "tip_v", "wall", "f_on_tip", "f_on_wall"]
HEADER = ["t", *(f"{name}_{i}" for name in VECTORS for i in "123"), "depth", "contact", "kinetic", "potential"]
STEPS, STEP = 10_000, 1e-3
POSITION_GAIN, VELOCITY_GAIN = 400.0, 40.0
FORCE, FORCE_GAIN, INTEGRAL_GAIN, FORCE_MASS, FORCE_DAMPING = 20.0, 0.5, 5.0, 1.0, 70.0
CONTACT_ON, CONTACT_OFF = 1.0, 0.5


class Hybrid:
    """Position across the wall's normal, force along it while there is contact."""

    def __init__(self, tip: np.ndarray) -> None:
        self.wanted, self.integral, self.touches = tip.copy(), 0.0, False

    def __call__(self, tip: np.ndarray, velocity: np.ndarray, force: np.ndarray, n: np.ndarray) -> np.ndarray:
        """The acceleration of the tip that is wanted."""
        pressing = n @ force
        self.touches = pressing > (CONTACT_OFF if self.touches else CONTACT_ON)
        motion = POSITION_GAIN * (self.wanted - tip) - VELOCITY_GAIN * velocity
        if not self.touches:
            self.integral = 0.0
            return motion
        error = FORCE - pressing
        along = FORCE_GAIN * error + INTEGRAL_GAIN * self.integral + FORCE_DAMPING * (n @ velocity)
        self.integral += STEP * error
        return motion - n * (n @ motion + along / FORCE_MASS)


def simulate() -> np.ndarray:
    model = mujoco.MjModel.from_xml_string(MJCF)
    model.body_gravcomp[:] = 0
    data = mujoco.MjData(model)
    data.qpos[:] = np.radians([0, -30, 60])
    mujoco.mj_forward(model, data)
    tip = data.site("tip")
    body = model.site("tip").bodyid[0]
    jacobian, jacobian_rate, mass = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    n, start = np.array([-1.0, 0.0, 0.0]), np.array([WALL_FAR, 0.0, 0.0])
    law = Hybrid(tip.xpos)
    rows = np.empty((STEPS + 1, len(HEADER)))
    for row in rows:
        data.qfrc_applied[:] = 0
        mujoco.mj_forward(model, data)
        mujoco.mj_jacSite(model, data, jacobian, None, tip.id)
        mujoco.mj_jacDot(model, data, jacobian_rate, None, tip.xpos, body)
        mujoco.mj_fullM(model, data, mass)
        velocity = jacobian @ data.qvel
        wall = start + WALL_SPEED * data.time * n
        depth = n @ (wall - tip.xpos)
        force = max(0.0, STIFFNESS * depth) * n
        wanted = np.linalg.solve(jacobian, law(tip.xpos, velocity, force, n) - jacobian_rate @ data.qvel)
        pushed = jacobian.T @ force
        tau = mass @ wanted + data.qfrc_bias - pushed
        data.qfrc_applied[:] = tau + pushed
        row[0] = data.time
        row[1:28] = np.concatenate([data.qpos, data.qvel, wanted, tau, tip.xpos, velocity, wall, force, -force])
        row[28:] = depth, depth > 0, data.energy[1], data.energy[0]
        mujoco.mj_step(model, data)
    return rows


imported = time.perf_counter()
rows = simulate()
simulated = time.perf_counter()
write(sys.argv[1], HEADER, rows)
written = time.perf_counter()

OURS = {"f_on_wall_1": (FORCE, 1e-4), "q_2": (-0.707482, 1e-5)}  # ours at the end, and how near
for name, (value, near) in OURS.items():
    assert abs(rows[-1, HEADER.index(name)] - value) < near, rows[-1]
print(json.dumps({"import": imported - begun, "loop": simulated - imported, "text": written - simulated}))
