from math import cos

W2, W3 = 1.3*9.80665, 2.1*9.80665


def gravity(q1, q2, q3):
    th = [q2, q2 + q3]
    moments = [[-W2*0.37*cos(th[0]), -W3*0.8*cos(th[0]), -W3*0.21*cos(th[1])]]
    moments += [[0, 0, moments[0][2]]]
    return [0] + [sum(row) for row in moments]
