from math import cos, sin


def coriolis(q1, q2, q3, qd1, qd2, qd3):
    A, B, C = 0.071 - 0.002 + 1.3*0.37**2 + 2.1*0.8**2, 0.043 - 0.003 + 2.1*0.21**2, 2.1*0.8*0.21
    c2, s2, c23, s23, s3 = cos(q2), sin(q2), cos(q2+q3), sin(q2+q3), sin(q3)
    d2 = -2*A*s2*c2 - 2*C*s2*c23
    d3 = -2*B*s23*c23 - 2*C*c2*s23
    w = qd2 + qd3
    yield qd1*(d2*qd2 + d3*w)
    yield -qd1**2*(d2 + d3)/2 - C*s3*qd3*(2*qd2 + qd3)
    yield -qd1**2*d3/2 + C*s3*qd2**2
