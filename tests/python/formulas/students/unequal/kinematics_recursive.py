from math import cos, sin


def point(links, angles, pitch=0.0):
    """(reach, height) of the end of a planar chain."""
    if not links:
        return 0.0, 0.0
    pitch = pitch + angles[0]
    r, z = point(links[1:], angles[1:], pitch)
    return r + links[0]*cos(pitch), z - links[0]*sin(pitch)


def kinematics(q):
    r, z = point([0.8, 0.55], q[1:])
    return [r*cos(q[0]), r*sin(q[0]), z + 0.25]
