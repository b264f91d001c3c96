import sympy as sp

q1, q2, q3, v1, v2, v3 = sp.symbols('q1 q2 q3 v1 v2 v3')
v = sp.Matrix([v1, v2, v3])
qs = sp.Matrix([q1, q2, q3])
c, s = sp.cos, sp.sin
p2 = 0.37*sp.Matrix([c(q1)*c(q2), s(q1)*c(q2), -s(q2)])
p3 = p2/0.37*0.8 + 0.21*sp.Matrix([c(q1)*c(q2 + q3), s(q1)*c(q2 + q3), -s(q2 + q3)])
u2, u3 = (p.jacobian(qs)*v for p in (p2, p3))
T = 1.3*u2.dot(u2)/2 + 2.1*u3.dot(u3)/2
T += (0.002*s(q2)**2 + 0.071*c(q2)**2)*v1**2/2 + 0.071*v2**2/2
T += (0.003*s(q2 + q3)**2 + 0.043*c(q2 + q3)**2)*v1**2/2 + 0.043*(v2 + v3)**2/2
T += 1.3083333333333334e-05*v1**2/2
M = sp.hessian(T, list(v))
fM = sp.lambdify((q1, q2, q3), M)


def mass_matrix(q):
    return fM(*q)
