from math import cos
LENGTHS, MASSES, G = (1.0, 1.0), (0.785, 0.785), 9.80665
def heights(q):
    angle = 0.0
    for joint, length in zip(q[1:], LENGTHS):
        angle += joint
        yield length*cos(angle)
def gravity(q):
    x = list(heights(q))
    t3 = MASSES[1]*G*x[1]/2
    return [0.0, MASSES[0]*G*x[0]/2 + MASSES[1]*G*x[0] + t3, sum(t for t in [t3])]
