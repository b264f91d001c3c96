from numpy import sin, cos, array
r = lambda q: cos(q[1]) + cos(q[1]+q[2])
z = lambda q: sin(q[1]) + sin(q[1]+q[2])
jacobian = lambda q: array([[-sin(q[0])*r(q), -cos(q[0])*z(q), -cos(q[0])*sin(q[1]+q[2])], [cos(q[0])*r(q), -sin(q[0])*z(q), -sin(q[0])*sin(q[1]+q[2])], [0, r(q), cos(q[1]+q[2])]])
