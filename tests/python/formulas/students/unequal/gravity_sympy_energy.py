import sympy as sp

q = sp.symbols('q1 q2 q3')
m2, m3, g = 1.3, 2.1, sp.Float('9.80665')
P = -m2*g*sp.Rational(37, 100)*sp.sin(q[1]) - m3*g*(0.8*sp.sin(q[1]) + 0.21*sp.sin(q[1] + q[2]))
G = [sp.diff(P, qi) for qi in q]
fun = sp.lambdify([q], G, modules='math')


def gravity(angles):
    return fun(list(angles))
