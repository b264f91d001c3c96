from math import cos, sin
a2, a3 = 0.8, 0.55
r = lambda q: a2*cos(q[1]) + a3*cos(q[1] + q[2])
h = lambda q: a2*sin(q[1]) + a3*sin(q[1] + q[2])
jacobian = lambda q: [[-sin(q[0])*r(q), -cos(q[0])*h(q), -cos(q[0])*a3*sin(q[1] + q[2])],
                      [cos(q[0])*r(q), -sin(q[0])*h(q), -sin(q[0])*a3*sin(q[1] + q[2])],
                      [0, -r(q), -a3*cos(q[1] + q[2])]]
