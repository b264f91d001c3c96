import numpy as np


def R_zyx(yaw, pitch, roll):
    cy, sy = np.cos(yaw), np.sin(yaw)
    cp, sp = np.cos(pitch), np.sin(pitch)
    cr, sr = np.cos(roll), np.sin(roll)
    return np.array([
        [cy*cp, cy*sp*sr - sy*cr, cy*sp*cr + sy*sr],
        [sy*cp, sy*sp*sr + cy*cr, sy*sp*cr - cy*sr],
        [-sp, cp*sr, cp*cr]])


def forward_kinematics(q):
    ex = np.array([1, 0, 0])
    elbow = np.array([0, 0, 0.25]) + 0.8*R_zyx(q[0], q[1], 0) @ ex
    return elbow + 0.55*R_zyx(q[0], q[1] + q[2], 0) @ ex
