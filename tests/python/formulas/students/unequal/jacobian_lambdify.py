import sympy as sp

q1, q2, q3 = sp.symbols('q1:4')
l2, l3, d1 = sp.symbols('l2 l3 d1')
Rz = sp.rot_axis3(-q1)
Ry = lambda t: sp.rot_axis2(-t)
p = sp.Matrix([0, 0, d1]) + Rz*(Ry(q2)*sp.Matrix([l2, 0, 0]) + Ry(q2 + q3)*sp.Matrix([l3, 0, 0]))
J = p.jacobian([q1, q2, q3]).subs({l2: 0.8, l3: 0.55, d1: 0.25})
f = sp.lambdify((q1, q2, q3), J, 'numpy')


def jacobian(th1, th2, th3):
    return f(th1, th2, th3)
