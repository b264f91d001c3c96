import numpy as np
from scipy.spatial.transform import Rotation
def tip(q):
    p = Rotation.from_euler("y", -q[2]).apply([1.0, 0, 0]) + np.array([1.0, 0, 0])
    p = Rotation.from_euler("y", -q[1]).apply(p)
    return Rotation.from_euler("z", q[0]).apply(p)
