import numpy as np
import matplotlib.pyplot as plt
from mpl_toolkits.mplot3d import Axes3D
def fk(q):
    r = np.cos(q[1]) + np.cos(q[1]+q[2])
    return np.array([np.cos(q[0])*r, np.sin(q[0])*r, np.sin(q[1]) + np.sin(q[1]+q[2])])
def jacobian(q, eps=1e-6):
    J = np.zeros((3, 3))
    for i in range(3):
        d = np.zeros(3); d[i] = eps
        J[:, i] = (fk(q+d) - fk(q-d))/(2*eps)
    return J
fig = plt.figure()
ax = fig.add_subplot(111, projection="3d")
if __name__ == "__main__":
    q = [float(x) for x in input("q1 q2 q3: ").split()]
    print(jacobian(np.array(q)))
    plt.show()
