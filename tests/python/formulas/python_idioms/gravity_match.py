import math
def gravity(q):
    t = []
    for i in range(3):
        match i:
            case 0: t.append(0)
            case 1: t.append(1.5*0.785*9.80665*math.cos(q[1]) + (last := 0.785*9.80665/2*math.cos(q[1]+q[2])))
            case _: t.append(last)
    return tuple(t)
