import numpy as np
def G_vector(q):
    m2 = m3 = 0.785
    g = 9.80665
    l = 1
    q2 = q[1, 0]; q3 = q[2, 0]
    return np.array([[0], [(m2/2+m3)*g*l*np.cos(q2) + m3*g*l/2*np.cos(q2+q3)], [m3*g*l/2*np.cos(q2+q3)]])
