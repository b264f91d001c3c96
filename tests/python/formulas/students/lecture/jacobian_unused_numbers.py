from math import sin, cos
a2, a3 = 1, 1  # both are 1 m, so they are left out below

def jacobian(q1, q2, q3):
    s, c = sin(q2)+sin(q2+q3), cos(q2)+cos(q2+q3)
    return [[-sin(q1)*c, -cos(q1)*s, -cos(q1)*sin(q2+q3)],
            [cos(q1)*c, -sin(q1)*s, -sin(q1)*sin(q2+q3)],
            [0, c, cos(q2+q3)]]
