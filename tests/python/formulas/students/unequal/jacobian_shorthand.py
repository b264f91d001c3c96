from numpy import array, cos, sin

A2 = 0.8
A3 = 0.55


def jacobian(q):
    global c1, s1, c2, s2, c23, s23
    c1, s1 = cos(q[0]), sin(q[0])
    c2, s2 = cos(q[1]), sin(q[1])
    c23, s23 = cos(q[1]+q[2]), sin(q[1]+q[2])
    return array([column1(), column2(), column3()]).T


def column1():
    return [-s1*(A2*c2+A3*c23), c1*(A2*c2+A3*c23), 0]


def column2():
    return [-c1*(A2*s2+A3*s23), -s1*(A2*s2+A3*s23), -(A2*c2+A3*c23)]


def column3():
    return [-c1*A3*s23, -s1*A3*s23, -A3*c23]
