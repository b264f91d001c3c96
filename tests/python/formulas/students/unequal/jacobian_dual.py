from math import cos, sin


class Dual:
    def __init__(self, x, d=0.0):
        self.x, self.d = x, d

    def __add__(self, other):
        return Dual(self.x + other.x, self.d + other.d)

    def __mul__(self, other):
        return Dual(self.x*other.x, self.x*other.d + self.d*other.x)


def C(u):
    return Dual(cos(u.x), -sin(u.x)*u.d)


def S(u):
    return Dual(sin(u.x), cos(u.x)*u.d)


def tip(u1, u2, u3):
    a2, a3 = Dual(0.8), Dual(0.55)
    r = a2*C(u2) + a3*C(u2 + u3)
    return [r*C(u1), r*S(u1), Dual(-1.0)*(a2*S(u2) + a3*S(u2 + u3))]


def jacobian(q1, q2, q3):
    columns = [tip(*(Dual(x, float(i == j)) for i, x in enumerate((q1, q2, q3)))) for j in range(3)]
    return [[column[row].d for column in columns] for row in range(3)]
