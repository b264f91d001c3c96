from math import sin, cos
def jacobian(q1, q2, q3, *, a2=1.0, a3=1.0, verbose=False):
    r = a2*cos(q2) + a3*cos(q2+q3)
    z = a2*sin(q2) + a3*sin(q2+q3)
    if verbose:
        print(f"{r=:.3f}")
    return [[-sin(q1)*r, -cos(q1)*z, -a3*cos(q1)*sin(q2+q3)],
            [cos(q1)*r, -sin(q1)*z, -a3*sin(q1)*sin(q2+q3)],
            [0, r, a3*cos(q2+q3)]]
