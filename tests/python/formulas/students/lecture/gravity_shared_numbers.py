from math import cos

a2 = 1
a3 = 1
half = 0.5
m = 0.785
g = 9.80665


def gravity(q1, q2, q3):
    t3 = -m*g*half*cos(q2+q3)
    t2 = -m*g*half*cos(q2) - m*g*a2*cos(q2) + t3
    return [0, t2, t3]
