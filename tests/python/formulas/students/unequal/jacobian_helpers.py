import math

A = {2: 0.8, 3: 0.55}
S = lambda *x: math.sin(sum(x))
C = lambda *x: math.cos(sum(x))


def jacobian(q):
    a, b, c = q
    R = A[2]*C(b) + A[3]*C(b, c)
    H = A[2]*S(b) + A[3]*S(b, c)
    J = [[None]*3 for _ in range(3)]
    J[0] = [-S(a)*R, -C(a)*H, -C(a)*A[3]*S(b, c)]
    J[1] = [C(a)*R, -S(a)*H, -S(a)*A[3]*S(b, c)]
    J[2] = [0, -R, -A[3]*C(b, c)]
    return J
