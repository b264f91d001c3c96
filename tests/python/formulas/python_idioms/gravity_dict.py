import numpy as np
params = {"m": [0.785, 0.785], "l": [1.0, 1.0], "g": 9.80665}
def gravity(q, params=params):
    m, l, g = params["m"], params["l"], params["g"]
    t3 = m[1]*g*l[1]/2*np.cos(q[1]+q[2])
    return np.array([0, (m[0]/2+m[1])*g*l[0]*np.cos(q[1]) + t3, t3])
