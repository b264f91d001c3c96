from math import cos, sin

a2, a3 = 0.8, 0.55
S = lambda *angles: sin(sum(angles))
C = lambda *angles: cos(sum(angles))
r = lambda q2, q3: a2*C(q2) + a3*C(q2, q3)
h = lambda q2, q3: a2*S(q2) + a3*S(q2, q3)


def jacobian(q):
    q1, q2, q3 = q
    return [
        [-S(q1)*r(q2, q3), -C(q1)*h(q2, q3), -C(q1)*a3*S(q2, q3)],
        [C(q1)*r(q2, q3), -S(q1)*h(q2, q3), -S(q1)*a3*S(q2, q3)],
        [0, r(q2, q3), a3*C(q2, q3)],
    ]
