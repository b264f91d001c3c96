import numpy as np
from numpy import matrix, sin, cos

def jacobian(q):
    c1, s1 = cos(q[0]), sin(q[0])
    R = matrix([[c1, -s1, 0], [s1, c1, 0], [0, 0, 1]])
    b = q[1] + q[2]
    plane = matrix([[0, -0.8*sin(q[1]) - 0.55*sin(b), -0.55*sin(b)],
                    [0.8*cos(q[1]) + 0.55*cos(b), 0, 0],
                    [0, -0.8*cos(q[1]) - 0.55*cos(b), -0.55*cos(b)]])
    return R*plane
