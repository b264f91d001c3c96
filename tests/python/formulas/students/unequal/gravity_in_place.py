import numpy as np

PARAMS = dict(m2=1.3, m3=2.1, l=0.8, c2=0.37, c3=0.21, g=9.80665)


def gravity(theta):
    p = PARAMS
    G = np.zeros(3)
    G[2] = p["m3"] * p["g"] * p["c3"] * np.cos(theta[1] + theta[2])
    G[1] = G[2]
    G[1] += (p["m2"] * p["c2"] + p["m3"] * p["l"]) * p["g"] * np.cos(theta[1])
    return G
