import numpy as np

m2, m3, a2, a3 = 0.785, 0.785, 1.0, 1.0
w = 0.01
axial = m2*(w**2 + w**2)/12
I2 = m2*(a2**2 + w**2)/12
I3 = m3*(a3**2 + w**2)/12


def M(q):
    c2, c3, c23, s2, s23 = np.cos(q[1]), np.cos(q[2]), np.cos(q[1]+q[2]), np.sin(q[1]), np.sin(q[1]+q[2])
    m11 = axial + I2*c2**2 + axial*s2**2 + I3*c23**2 + axial*s23**2 + m2*(a2/2*c2)**2 + m3*(a2*c2 + a3/2*c23)**2
    m33 = I3 + m3*a3**2/4
    m23 = m33 + m3*a2*a3/2*c3
    m22 = I2 + m2*a2**2/4 + m3*a2**2 + m33 + m3*a2*a3*c3
    return np.array([[m11, 0, 0], [0, m22, m23], [0, m23, m33]])
