"""The lecture's arm for the peers' Python APIs, in the simscape convention."""

from __future__ import annotations

from typing import Any

import numpy as np

MASS, LENGTH, AXIAL, ACROSS = 0.785, 1.0, 1.3083333333333334e-5, 0.06542320833333333  # kg, m, kg m^2
GRAVITY = 9.80665  # m/s^2

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
