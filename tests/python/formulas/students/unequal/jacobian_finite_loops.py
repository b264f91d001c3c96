import math

LINKS = [0.8, 0.55]


def direction(q1, pitch):
    return [math.cos(pitch) * math.cos(q1), math.cos(pitch) * math.sin(q1), -math.sin(pitch)]


def derivative(q1, pitch):
    return [-math.sin(pitch) * math.cos(q1), -math.sin(pitch) * math.sin(q1), -math.cos(pitch)]


def jacobian(q1, q2, q3):
    pitches = [q2, q2 + q3]
    J = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    for link in range(2):
        x, y, _ = direction(q1, pitches[link])
        J[0][0] -= LINKS[link] * y
        J[1][0] += LINKS[link] * x
        slope = derivative(q1, pitches[link])
        for row in range(3):
            J[row][1] += LINKS[link] * slope[row]
            if link == 1:
                J[row][2] += LINKS[link] * slope[row]
    return J
