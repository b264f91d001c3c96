"""The lecture's moving wall as one would write it with MuJoCo's Python API: python mujoco_moving_wall.py OUT.csv

10 s in steps of 1 ms by RK4; gravity compensation; the wall's position, the penalty force and the flag in every one of
10 001 rows, with motion, torques, tip and energies beside them. Prints where the time went as JSON.
"""

from __future__ import annotations

import json
import sys
import time

begun = time.perf_counter()
import mujoco  # noqa: E402
import numpy as np  # noqa: E402
from mujoco_rows import write  # noqa: E402
from peer_arms import MJCF  # noqa: E402

VECTORS = ["q", "qd", "qdd", "tau", "tip", "tip_v", "wall", "f_on_tip", "f_on_wall"]
HEADER = ["t", *(f"{name}_{i}" for name in VECTORS for i in "123"), "depth", "contact", "kinetic", "potential"]
STEPS, SPEED, STIFFNESS = 10_000, 0.05, 1000.0


def simulate() -> np.ndarray:
    model = mujoco.MjModel.from_xml_string(MJCF)
    data = mujoco.MjData(model)
    data.qpos[:] = np.radians([0, -30, 60])
    tip = data.site("tip")
    jacobian = np.zeros((3, 3))
    normal = np.array([-1.0, 0.0, 0.0])
    start = np.array([2.0, 0.0, 0.0])
    rows = np.empty((STEPS + 1, len(HEADER)))
    for row in rows:
        mujoco.mj_forward(model, data)
        mujoco.mj_jacSite(model, data, jacobian, None, tip.id)
        wall = start + SPEED * data.time * normal
        depth = normal @ (wall - tip.xpos)
        force = max(0.0, STIFFNESS * depth) * normal
        row[0] = data.time
        row[1:28] = np.concatenate(
            [data.qpos, data.qvel, data.qacc, data.qfrc_passive, tip.xpos, jacobian @ data.qvel, wall, force, -force]
        )
        row[28:] = depth, depth > 0, data.energy[1], data.energy[0]
        mujoco.mj_step(model, data)
    return rows


imported = time.perf_counter()
rows = simulate()
simulated = time.perf_counter()
write(sys.argv[1], HEADER, rows)
written = time.perf_counter()

assert abs(rows[-1, HEADER.index("f_on_wall_1")] - 232.0508075689) < 1e-6, rows[-1]
print(json.dumps({"import": imported - begun, "loop": simulated - imported, "text": written - simulated}))
