import math


def gravity(q3, q2, q1):
    """Without a letter: the centre of link 3 is 0.3 m from joint 3."""
    hanging = 0.7 * 9.80665 * 0.3 * math.cos(q2 + q3)
    return [0, -(0.6 + 0.7) * 9.80665 * 0.8 * math.cos(q2) - hanging, -hanging]
