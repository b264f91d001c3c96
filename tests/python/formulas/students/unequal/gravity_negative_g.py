from numpy import array, cos

g = -9.80665
m2, m3 = 1.3, 2.1
lc2, lc3, a2 = 0.37, 0.21, 0.8


def gravity(q):
    third = m3*g*lc3*cos(q[1] + q[2])
    return array([0, (m2*lc2 + m3*a2)*g*cos(q[1]) + third, third])
