"""Kinematics of an ABB IRB 2400 with its wrist straight: tip, Jacobian, and the joint angles of a point. The numbers
are those of abb_irb2400_support/urdf/irb2400.urdf in github.com/ros-industrial/abb (Apache-2.0). That file has no
masses: a body of 1 kg stands in their place, and no force follows from it."""

import arm3r_cpp as arm3r
import numpy as np

a1, a2 = 0.1, 0.705
a3, bend = np.hypot(0.84, 0.135), np.arctan2(0.135, 0.84)  # from joint 3 to the tip, and how the forearm is bent
body = "mass: 1, com: [0, 0, 0], inertia: [1, 1, 1, 0, 0, 0]"
arm = arm3r.Scenario(f"""
format: 1
arm:
  model: elbow
  convention: urdf
  joint_sign: [1, -1, -1]
  joint_zero: [0, {np.pi / 2}, {bend - np.pi / 2}]
  base: {{position: [0, 0, 0.615]}}
  shoulder_offset: {a1}
  link2: {{length: {a2}, {body}}}
  link3: {{tip: [{a3}, 0, 0], {body}}}
initial: {{q: [0, 0, 0]}}
""").arm
print("at zero the tip is at", arm.tip_position([0, 0, 0]).round(6), "m")
q = arm.inverse_kinematics([0.9, 0.4, 0.8])
print("it is at [0.9 0.4 0.8] m with joints at", np.degrees(q).round(3), "deg")
J = arm.jacobian(q)
print("its Jacobian there, m:", *J.round(4), sep="\n  ")
by_hand = a2 * a3 * np.hypot(0.9, 0.4) * np.sin(q[2] + np.pi / 2 - bend)  # the offset a1 is in the radius only
print(f"det J {np.linalg.det(J):.6f} m^3, by hand {by_hand:.6f} m^3")
