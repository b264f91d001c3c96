from functools import partial
from math import cos
def torque(q, mass, gravity_constant):
    w = mass*gravity_constant
    return [0, 1.5*w*cos(q[1]) + w/2*cos(q[1]+q[2]), w/2*cos(q[1]+q[2])]
gravity = partial(torque, mass=0.785, gravity_constant=9.80665)
