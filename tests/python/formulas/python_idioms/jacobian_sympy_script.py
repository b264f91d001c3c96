from sympy import symbols, Matrix, cos, sin, simplify
q1, q2, q3, l2, l3 = symbols("q1 q2 q3 l2 l3")
T = Matrix([cos(q1)*(l2*cos(q2) + l3*cos(q2+q3)), sin(q1)*(l2*cos(q2) + l3*cos(q2+q3)), l2*sin(q2)+l3*sin(q2+q3)])
J = simplify(T.jacobian(Matrix([q1, q2, q3])))
print(J)
