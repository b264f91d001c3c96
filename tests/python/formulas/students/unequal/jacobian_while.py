import numpy as np

def jacobian(q, a=(0.8, 0.55)):
    """Walk from the tip back to the base."""
    s, c = np.sin, np.cos
    J = np.zeros((3, 3))
    i, x, z = 2, 0.0, 0.0
    while i >= 1:
        pitch = sum(q[1:i+1])
        x += a[i-1]*c(pitch)
        z -= a[i-1]*s(pitch)
        J[:, i] = [c(q[0])*z, s(q[0])*z, -x]
        i -= 1
    J[:, 0] = [-s(q[0])*x, c(q[0])*x, 0]
    return J
