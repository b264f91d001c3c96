"""The lecture's arm for the peers: as MuJoCo and Pinocchio take it (simscape), and as formulas in link angles."""

from __future__ import annotations

from typing import Any

import numpy as np

MASS, LENGTH, AXIAL, ACROSS = 0.785, 1.0, 1.3083333333333334e-5, 0.06542320833333333  # kg, m, kg m^2
GRAVITY = 9.80665  # m/s^2
WALL_FAR, WALL_NEAR, WALL_SPEED, STIFFNESS = 2.0, 1.735, 0.05, 1000.0  # m: the lecture's, 3 mm from the tip; m/s, N/m

# The lumped numbers of docs/model.md, (3.2).
HALF = MASS * (LENGTH / 2) ** 2
A1, A2, A3 = 3 * AXIAL, ACROSS - AXIAL + HALF + MASS * LENGTH**2, ACROSS - AXIAL + HALF
B2, B3, B = ACROSS + HALF + MASS * LENGTH**2, ACROSS + HALF, MASS * LENGTH * LENGTH / 2
G2, G3 = MASS * LENGTH / 2 + MASS * LENGTH, MASS * LENGTH / 2

MJCF = f"""
<mujoco>
  <compiler angle="radian"/>
  <option integrator="RK4" timestep="0.001" gravity="0 0 {-GRAVITY}">
    <flag constraint="disable" contact="disable" energy="enable"/>
  </option>
  <worldbody>
    <body>
      <joint axis="0 0 1"/>
      <inertial mass="{MASS}" pos="0 0 0" diaginertia="{AXIAL} {AXIAL} {AXIAL}"/>
      <body gravcomp="1">
        <joint axis="0 1 0"/>
        <inertial mass="{MASS}" pos="{LENGTH / 2} 0 0" diaginertia="{AXIAL} {ACROSS} {ACROSS}"/>
        <body gravcomp="1" pos="{LENGTH} 0 0">
          <joint axis="0 1 0"/>
          <inertial mass="{MASS}" pos="{LENGTH / 2} 0 0" diaginertia="{AXIAL} {ACROSS} {ACROSS}"/>
          <site name="tip" pos="{LENGTH} 0 0"/>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def pinocchio_model() -> Any:
    import pinocchio as pin

    turret = pin.Inertia(MASS, np.zeros(3), AXIAL * np.eye(3))
    bar = pin.Inertia(MASS, np.array([LENGTH / 2, 0, 0]), np.diag([AXIAL, ACROSS, ACROSS]))
    level = pin.SE3(np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]), np.zeros(3))  # z along base y
    along = pin.SE3(np.eye(3), np.array([LENGTH, 0, 0]))
    model = pin.Model()
    joint = 0
    for body, placement in ((turret, pin.SE3.Identity()), (bar, level), (bar, along)):
        joint = model.addJoint(joint, pin.JointModelRZ(), placement, f"joint{joint + 1}")
        model.appendBodyToJoint(joint, body, pin.SE3.Identity())
    model.gravity.linear = np.array([0, 0, -GRAVITY])
    return model


def mujoco_model() -> Any:
    """In free fall, nothing computed beside the motion."""
    import ctypes

    import mujoco

    # The Python package has a clock read several times a step, which doubles its time; the C library has none.
    library = ctypes.CDLL(f"libmujoco.so.{mujoco.__version__}")
    ctypes.c_void_p.in_dll(library, "mjcb_time").value = None
    model = mujoco.MjModel.from_xml_string(MJCF)
    model.body_gravcomp[:] = 0
    model.opt.enableflags = 0
    return model


# ---- formulas -------------------------------------------------------------------------------------------------------


def link_angles(q: np.ndarray) -> np.ndarray:
    """Joint angle 1 and the absolute angles of links 2 and 3, positive upwards, of simscape angles: (..., 3), rad."""
    return np.stack([q[..., 0], -q[..., 1], -q[..., 1] - q[..., 2]], axis=-1)


def joint_angles(links: np.ndarray) -> np.ndarray:
    """Its inverse."""
    return np.stack([links[..., 0], -links[..., 1], links[..., 1] - links[..., 2]], axis=-1)


def reach(functions: Any, y: Any) -> Any:
    """The tip along base x, m; `functions` has the sin and cos of the numbers in y."""
    return functions.cos(y[0]) * LENGTH * (functions.cos(y[1]) + functions.cos(y[2]))


def rate(functions: Any, y: Any, *, weight: float = GRAVITY, tau: Any = (0, 0, 0), push: Any = 0) -> list[Any]:
    """The rate of y, the three angles above and their rates, by (3.8).

    Args:
        functions: has the sin and cos of the numbers in y: math, heyoka, casadi.
        weight: what gravity the links feel, m/s^2.
        tau: joint torques, slide convention, N m.
        push: force on the tip along base x, N.
    """
    q1, p2, p3, w1, w2, w3 = y
    (s1, c1), (s2, c2), (s3, c3) = ((functions.sin(angle), functions.cos(angle)) for angle in (q1, p2, p3))
    cos, sin = c2 * c3 + s2 * s3, s3 * c2 - c3 * s2
    p, q = A2 * c2 + B * c3, A3 * c3 + B * c2
    r1 = tau[0] - LENGTH * (c2 + c3) * s1 * push + 2 * (s2 * p * w2 + s3 * q * w3) * w1
    r2 = tau[1] - tau[2] - G2 * weight * c2 - s2 * p * w1 * w1 + B * sin * w3 * w3 - LENGTH * s2 * c1 * push
    r3 = tau[2] - G3 * weight * c3 - s3 * q * w1 * w1 - B * sin * w2 * w2 - LENGTH * s3 * c1 * push
    coupling = B * cos
    inverse = 1 / (B2 * B3 - coupling * coupling)
    return [
        w1,
        w2,
        w3,
        r1 / (A1 + c2 * p + c3 * q),
        (B3 * r2 - coupling * r3) * inverse,
        (B2 * r3 - coupling * r2) * inverse,
    ]
