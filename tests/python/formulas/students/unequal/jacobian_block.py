import numpy as np

L1, L2 = 0.8, 0.55


def jacobian(theta):
    t1, t2, t3 = theta
    radial = np.array([np.cos(t1), np.sin(t1)])[:, None]
    tangent = np.array([-np.sin(t1), np.cos(t1)])[:, None]
    rho = L1*np.cos(t2) + L2*np.cos(t2 + t3)
    drho = np.array([[-L1*np.sin(t2) - L2*np.sin(t2 + t3), -L2*np.sin(t2 + t3)]])
    dz = np.array([[-L1*np.cos(t2) - L2*np.cos(t2 + t3), -L2*np.cos(t2 + t3)]])
    return np.block([[rho*tangent, radial @ drho], [np.zeros((1, 1)), dz]])
