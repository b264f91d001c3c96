from math import cos

W2 = 1.3*9.80665
W3 = 2.1*9.80665


def grav(q3, q2, q1):
    elbow = 0.8*cos(q2)
    tau3 = -W3*0.21*cos(q2 + q3)
    tau2 = -W2*0.37*cos(q2) - W3*elbow + tau3
    tau1 = 0
    return tau3, tau2, tau1
