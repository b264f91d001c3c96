from math import cos
M = {2: 1.3, 3: 2.1}
LC = {2: 0.37, 3: 0.21}
def moment(joint, q2, q3):
    g = 9.80665
    match joint:
        case 1:
            return 0.0
        case 2:
            return -g*((M[2]*LC[2] + M[3]*0.8)*cos(q2) + M[3]*LC[3]*cos(q2 + q3))
        case 3:
            return -g*M[3]*LC[3]*cos(q2 + q3)
def gravity(q1, q2, q3):
    return [moment(j, q2, q3) for j in (1, 2, 3)]
