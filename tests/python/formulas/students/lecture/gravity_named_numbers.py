import numpy as np

LINK_LENGTH = {'upper': 1.0, 'fore': 1.0}
LINK_MASS = {'upper': 0.785, 'fore': 0.785}
G = np.array([0, 0, -9.80665])


def gravity(q):
    c = np.cos(q[1]), np.cos(q[1] + q[2])
    upper = np.array([0, c[0]*LINK_LENGTH['upper']/2, 0])
    fore = np.array([0, c[0]*LINK_LENGTH['upper'] + c[1]*LINK_LENGTH['fore']/2, c[1]*LINK_LENGTH['fore']/2])
    return G[2]*(LINK_MASS['upper']*upper + LINK_MASS['fore']*fore)
