import sympy as sp
from sympy.physics.mechanics import dynamicsymbols
t = sp.symbols("t")
q = sp.Matrix(dynamicsymbols("q1:4"))
m2, m3, a2, a3, g = sp.symbols("m2 m3 a2 a3 g")
z2 = a2/2*sp.sin(q[1])
z3 = a2*sp.sin(q[1]) + a3/2*sp.sin(q[1]+q[2])
V = g*(m2*z2 + m3*z3)
G = sp.Matrix([V]).jacobian(q).T
