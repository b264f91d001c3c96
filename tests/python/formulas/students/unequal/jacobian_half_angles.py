from math import tan

a2 = .8
a3 = .55


def sc(x):
    t = tan(x / 2)
    return 2 * t / (1 + t**2), (1 - t**2) / (1 + t**2)


def jacobian(q):
    (s1, c1), (s2, c2), (s3, c3) = map(sc, q)
    s23, c23 = s2*c3 + c2*s3, c2*c3 - s2*s3
    b, d = a2*c2 + a3*c23, a2*s2 + a3*s23
    return [[-s1*b, -c1*d, -a3*c1*s23], [c1*b, -s1*d, -a3*s1*s23], [0, -b, -a3*c23]]
