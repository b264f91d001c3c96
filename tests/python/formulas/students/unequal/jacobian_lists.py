from math import sin, cos
# list comprehensions only, slide convention (z up)
def jacobian(q):
    L = [0.8, 0.55]
    th = [q[1], q[1] + q[2]]
    rad = [[-L[k]*sin(th[k]) if k >= j else 0 for k in range(2)] for j in range(2)]
    ver = [[L[k]*cos(th[k]) if k >= j else 0 for k in range(2)] for j in range(2)]
    reach = sum(L[k]*cos(th[k]) for k in range(2))
    first = [-reach*sin(q[0]), reach*cos(q[0]), 0]
    rest = [[sum(rad[j])*cos(q[0]), sum(rad[j])*sin(q[0]), sum(ver[j])] for j in range(2)]
    return list(zip(first, *rest))
