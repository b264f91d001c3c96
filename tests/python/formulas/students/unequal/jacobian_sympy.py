import sympy as sp

q1, q2, q3 = sp.symbols("q1 q2 q3")
L2, L3 = 0.8, 0.55
x = sp.cos(q1)*(L2*sp.cos(q2) + L3*sp.cos(q2 + q3))
y = sp.sin(q1)*(L2*sp.cos(q2) + L3*sp.cos(q2 + q3))
z = -L2*sp.sin(q2) - L3*sp.sin(q2 + q3)
tip = sp.Matrix([x, y, z])
evaluate = sp.lambdify((q1, q2, q3), tip.jacobian([q1, q2, q3]), "numpy")


def jacobian(q):
    return evaluate(*q)
