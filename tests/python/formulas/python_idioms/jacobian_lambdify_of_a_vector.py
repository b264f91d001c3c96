import sympy as sp
q = sp.symbols("q1:4")
r = sp.cos(q[1]) + sp.cos(q[1]+q[2])
p = sp.Matrix([sp.cos(q[0])*r, sp.sin(q[0])*r, sp.sin(q[1])+sp.sin(q[1]+q[2])])
jac_func = sp.lambdify([q], p.jacobian(sp.Matrix(q)))
