from math import cos

a2, a3, m2, m3, g = 0.8, 0.6, 1.2, 0.7, 9.80665


def gravity(q3, q2, q1):
    t3 = -m3 * g * a3 / 2 * cos(q2 + q3)
    return t3, -(m2 / 2 + m3) * g * a2 * cos(q2) + t3, 0.0
