import numpy as np

def product(a, b):
    w, v = a[0], a[1:]
    return np.r_[w*b[0] - v @ b[1:], w*b[1:] + b[0]*v + np.cross(v, b[1:])]

def about(axis, angle):
    return np.r_[np.cos(angle/2), np.sin(angle/2)*np.array(axis, float)]

def turned(u, v):
    return product(product(u, np.r_[0.0, v]), u*[1, -1, -1, -1])[1:]

def kinematics(q):
    first = product(about([0, 0, 1], q[0]), about([0, 1, 0], q[1]))
    second = product(first, about([0, 1, 0], q[2]))
    return turned(first, np.array([1.0, 0, 0])) + turned(second, np.array([1.0, 0, 0]))
