import numpy as np

bodies = [dict(m=1.3, arms=[0.37]), dict(m=2.1, arms=[0.8, 0.21])]


def gravity(q):
    g = 9.80665
    tau = np.zeros(3)
    for body in bodies:
        Jz = np.zeros(3)
        for j in (1, 2):
            Jz[j] = -sum(l*np.cos(q[1:i + 2].sum()) for i, l in enumerate(body['arms']) if i + 1 >= j)
        tau += body['m']*g*Jz
    return tau
