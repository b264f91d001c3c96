import numpy as np

A, B, C = 0.071 + 1.3*0.37**2 + 2.1*0.8**2, 0.043 + 2.1*0.21**2, 2.1*0.8*0.21
g = 9.80665


def inverse_dynamics(q, dq, ddq):
    q1, q2, q3 = q
    w1, w2, w3 = dq
    b1, b2, b3 = ddq
    c2, s2, c23, s23, c3, s3 = np.cos(q2), np.sin(q2), np.cos(q2+q3), np.sin(q2+q3), np.cos(q3), np.sin(q3)
    M11 = 1.3083333333333334e-05 + 0.002*s2**2 + 0.003*s23**2 + A*c2**2 + B*c23**2 + 2*C*c2*c23
    dM2 = 2*(0.002 - A)*s2*c2 + 2*(0.003 - B)*s23*c23 - 2*C*(s2*c23 + c2*s23)
    dM3 = 2*(0.003 - B)*s23*c23 - 2*C*c2*s23
    t1 = M11*b1 + (dM2*w2 + dM3*w3)*w1
    t2 = (A + B + 2*C*c3)*b2 + (B + C*c3)*b3 - C*s3*(2*w2*w3 + w3**2) - dM2*w1**2/2
    t3 = (B + C*c3)*b2 + B*b3 + C*s3*w2**2 - dM3*w1**2/2
    t2 -= g*((1.3*0.37 + 2.1*0.8)*c2 + 2.1*0.21*c23)
    t3 -= g*2.1*0.21*c23
    return np.array([t1, t2, t3])
