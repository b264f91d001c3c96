from functools import lru_cache, partial
import numpy as np
@lru_cache(maxsize=None)
def trig(t): return np.sin(t), np.cos(t)
def jacobian(q1, q2, q3, a2=0.8, a3=0.55):
    (s1, c1), (s2, c2), (s23, c23) = map(trig, (q1, q2, q2 + q3))
    J3 = np.array([-c1*s23, -s1*s23, -c23])*a3
    J2 = np.array([-c1*s2, -s1*s2, -c2])*a2 + J3
    J1 = np.array([-s1, c1, 0])*(a2*c2 + a3*c23)
    return np.c_[J1, J2, J3]
