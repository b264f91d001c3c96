import sympy as sp
q1, q2, q3 = sp.symbols("q1 q2 q3")
r = sp.cos(q2) + sp.cos(q2+q3)
p = sp.Matrix([sp.cos(q1)*r, sp.sin(q1)*r, sp.sin(q2)+sp.sin(q2+q3)])
J = p.jacobian([q1, q2, q3])
jacobian = sp.lambdify((q1, q2, q3), J, "numpy")
