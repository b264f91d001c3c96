from functools import reduce
import numpy as np
import numpy.typing as npt
Array = npt.NDArray[np.float64]
DH = [(0.0, np.pi/2, 0.0), (1.0, 0.0, 0.0), (1.0, 0.0, 0.0)]
def A(theta: float, a: float, alpha: float, d: float) -> Array:
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[ct, -st*ca, st*sa, a*ct], [st, ct*ca, -ct*sa, a*st], [0, sa, ca, d], [0, 0, 0, 1]])
def jacobian(q: Array) -> Array:
    Ts = [np.eye(4)] + [reduce(np.matmul, [A(t, *row) for t, row in zip(q[:i+1], DH)]) for i in range(3)]
    p = Ts[-1][:3, 3]
    return np.column_stack([np.r_[np.cross(T[:3, 2], p - T[:3, 3]), T[:3, 2]] for T in Ts[:-1]])
