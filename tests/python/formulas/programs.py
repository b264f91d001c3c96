"""Right programs: four styles, both conventions, Python and MATLAB."""

from __future__ import annotations

from typing import NamedTuple


class Program(NamedTuple):
    name: str
    kind: str
    convention: str
    text: str
    language: str = "python"


CONSTANTS = "a2 = 1.0\na3 = 1.0\nm2 = 0.785\nm3 = 0.785\ng = 9.80665\n"
LENGTHS = "a2 = 1.0\na3 = 1.0\n"

JACOBIAN_LISTED = """
from math import sin, cos

def jacobian(q3, q2, q1):
    a2 = 1
    a3 = 1
    j11 = -sin(q1)*(a3*cos(q2+q3)+a2*cos(q2))
    j12 = -cos(q1)*(a3*sin(q2+q3)+a2*sin(q2))
    j13 = -a3*sin(q2+q3)*cos(q1)
    j21 = cos(q1)*(a3*cos(q2+q3)+a2*cos(q2))
    j22 = -sin(q1)*(a3*sin(q2+q3)+a2*sin(q2))
    j23 = -a3*sin(q2+q3)*sin(q1)
    j31 = 0
    j32 = SIGN(a3*cos(q2+q3)+a2*cos(q2))
    j33 = SIGN(a3*cos(q2+q3))
    return [[j11, j12, j13], [j21, j22, j23], [j31, j32, j33]]
"""

JACOBIAN_BY_REACH = """
import numpy as np
a2, a3 = 1.0, 1.0

def jacobian(q):
    q1, q2, q3 = q
    r = a2*np.cos(q2) + a3*np.cos(q2 + q3)
    h = a2*np.sin(q2) + a3*np.sin(q2 + q3)
    c1, s1 = np.cos(q1), np.sin(q1)
    s23, c23 = np.sin(q2 + q3), np.cos(q2 + q3)
    return np.array([[-s1*r, -c1*h, -c1*a3*s23],
                     [c1*r, -s1*h, -s1*a3*s23],
                     [0, SIGN(r), SIGN(a3*c23)]])
"""

JACOBIAN_BY_CROSS_PRODUCTS = """
import numpy as np
a2 = 1.0
a3 = 1.0

def jacobian(q):
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    z1 = np.array([0, 0, 1])
    z2 = SIGN(np.array([s1, -c1, 0]))
    u = np.array([c1, s1, 0])
    up = SIGN(np.array([0, 0, 1]))
    elbow = a2*np.cos(q[1])*u + a2*np.sin(q[1])*up
    tip = elbow + a3*np.cos(q[1] + q[2])*u + a3*np.sin(q[1] + q[2])*up
    columns = [np.cross(z1, tip), np.cross(z2, tip), np.cross(z2, tip - elbow)]
    return np.array(columns).T
"""

JACOBIAN_BY_TRANSFORMS = """
import numpy as np
a2 = 1.0
a3 = 1.0

def turn(angle, alpha, a):
    c, s = np.cos(angle), np.sin(angle)
    ca, sa = np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s*ca, s*sa, a*c],
                     [s, c*ca, -c*sa, a*s],
                     [0, sa, ca, 0],
                     [0, 0, 0, 1]])

def jacobian(q):
    T1 = turn(q[0], SIGN(np.pi/2), 0)
    T2 = T1 @ turn(q[1], 0, a2)
    T3 = T2 @ turn(q[2], 0, a3)
    J = np.zeros((3, 3))
    tip = T3[:3, 3]
    J[:, 0] = np.cross([0, 0, 1], tip)
    J[:, 1] = np.cross(T1[:3, 2], tip - T1[:3, 3])
    J[:, 2] = np.cross(T2[:3, 2], tip - T2[:3, 3])
    return J
"""

GRAVITY_LISTED = """
from math import sin, cos

def gravity(q3, q2, q1):
    m2 = 0.785
    m3 = 0.785
    g = 9.80665
    a2 = 1
    a3 = 1
    t1 = q1*0
    t2 = SIGN(m2*g*(a2/2)*cos(q2)+m3*g*(a2*cos(q2)+(a3/2)*cos(q2+q3)))
    t3 = SIGN(m3*g*(a3/2)*cos(q2+q3))
    return t3, t2, t1
"""

GRAVITY_BY_CENTRES = """
import numpy as np
a2, a3 = 1.0, 1.0
m2, m3, g = 0.785, 0.785, 9.80665

def gravity_torque(q):
    c2, c23 = np.cos(q[1]), np.cos(q[1] + q[2])
    h2 = np.array([0, a2*c2/2, 0])
    h3 = np.array([0, a2*c2 + a3*c23/2, a3*c23/2])
    return SIGN(g*(m2*h2 + m3*h3))
"""

GRAVITY_BY_RECURSION = """
import numpy as np
a2, a3 = 1.0, 1.0
m2, m3, g = 0.785, 0.785, 9.80665

def gravity_torque(q):
    angle2 = q[1]
    angle3 = q[1] + q[2]
    f3 = m3*g
    n3 = f3*a3/2*np.cos(angle3)
    f2 = f3 + m2*g
    n2 = n3 + f3*a2*np.cos(angle2) + m2*g*a2/2*np.cos(angle2)
    return [0, SIGN(n2), SIGN(n3)]
"""

KINEMATICS_CLOSED = """
import numpy as np
a2, a3 = 1.0, 1.0

def tip_position(q1, q2, q3):
    r = a2*np.cos(q2) + a3*np.cos(q2 + q3)
    h = a2*np.sin(q2) + a3*np.sin(q2 + q3)
    return np.array([r*np.cos(q1), r*np.sin(q1), SIGN(h)])
"""

KINEMATICS_BY_TRANSFORMS = """
import numpy as np
a2 = 1.0
a3 = 1.0

def Rz(t):
    return np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])

def Ry(t):
    return np.array([[np.cos(t), 0, np.sin(t)], [0, 1, 0], [-np.sin(t), 0, np.cos(t)]])

def forward_kinematics(q):
    second = Ry(OTHER(q[1]))
    third = Ry(OTHER(q[2]))
    link3 = np.array([a3, 0, 0])
    link2 = np.array([a2, 0, 0])
    return Rz(q[0]) @ second @ (link2 + third @ link3)
"""

MASS_CLOSED = """
import numpy as np

def mass_matrix(q, a2, a3, m2, m3, lc2, lc3, I2, I3):
    c2, c23, c3 = np.cos(q[1]), np.cos(q[1] + q[2]), np.cos(q[2])
    A2 = m2*lc2**2 + m3*a2**2
    A3 = m3*lc3**2
    B = m3*a2*lc3
    m22 = I2 + I3 + A2 + A3 + 2*B*c3
    m23 = I3 + A3 + B*c3
    axial = 1.3083333333333334e-05
    m11 = axial*3 + (A2 + I2 - axial)*c2**2 + (A3 + I3 - axial)*c23**2 + 2*B*c2*c23
    return np.array([[m11, 0, 0], [0, m22, m23], [0, m23, I3 + A3]])
"""

MATLAB_JACOBIAN = """function J = fcn(q3,q2,q1)
    a2=1;
    a3=1;

    j11 = -sin(q1)*(a3*cos(q2+q3)+a2*cos(q2));
    j12 = -cos(q1)*(a3*sin(q2+q3)+a2*sin(q2));
    j13 = -a3*sin(q2+q3)*cos(q1);

    j21 = cos(q1)*(a3*cos(q2+q3)+a2*cos(q2));
    j22 = -sin(q1)*(a3*sin(q2+q3)+a2*sin(q2));
    j23 = -a3*sin(q2+q3)*sin(q1);

    j31 = 0;
    j32 = a3*cos(q2+q3)+a2*cos(q2);
    j33 = a3*cos(q2+q3);

    J = [j11 j12 j13; j21 j22 j23; -j31 SIGN(j32) SIGN(j33)];
"""

MATLAB_GRAVITY = """function [t3, t2, t1] = fcn(q3, q2, q1)
m2=0.785;
m3=0.785;
g=9.80665;
a2=1;
a3=1;
t1 = q1*0;
t2 = SIGN(m2*g*(a2/2)*cos(q2) + m3*g*(a2*cos(q2) + (a3/2)*cos(q2+q3)));
t3 = SIGN(m3*g*(a3/2)*cos(q2+q3));
"""

MATLAB_BY_TRANSFORMS = """% the Jacobian by homogeneous transforms
function J = jacobian(q)
a2 = 1; a3 = 1;
T1 = turn(q(1), SIGN(pi/2), 0);
T2 = T1*turn(q(2), 0, a2);
T3 = T2*turn(q(3), 0, a3);
tip = T3(1:3,4);
J = [cross([0;0;1], tip), cross(T1(1:3,3), tip - T1(1:3,4)), ...
     cross(T2(1:3,3), tip - T2(1:3,4))];
end

function T = turn(angle, alpha, a)
c = cos(angle); s = sin(angle);
ca = cos(alpha); sa = sin(alpha);
T = [c -s*ca s*sa a*c
     s c*ca -c*sa a*s
     0 sa ca 0
     0 0 0 1];
end
"""


def _signed(text: str, convention: str) -> str:
    """SIGN(x) is x in slide and -(x) in simscape; OTHER(x) the other way round."""
    minus, plus = ("-(", "(") if convention == "simscape" else ("(", "-(")
    return text.replace("SIGN(", minus).replace("OTHER(", plus if convention == "slide" else "(").lstrip("\n")


_TEMPLATES = (
    ("listed jacobian", "jacobian", JACOBIAN_LISTED, "python"),
    ("jacobian by reach", "jacobian", JACOBIAN_BY_REACH, "python"),
    ("jacobian by cross products", "jacobian", JACOBIAN_BY_CROSS_PRODUCTS, "python"),
    ("jacobian by transforms", "jacobian", JACOBIAN_BY_TRANSFORMS, "python"),
    ("listed gravity", "gravity", GRAVITY_LISTED, "python"),
    ("gravity by centres", "gravity", GRAVITY_BY_CENTRES, "python"),
    ("gravity by recursion", "gravity", GRAVITY_BY_RECURSION, "python"),
    ("closed kinematics", "kinematics", KINEMATICS_CLOSED, "python"),
    ("kinematics by transforms", "kinematics", KINEMATICS_BY_TRANSFORMS, "python"),
    ("closed mass matrix", "mass", MASS_CLOSED, "python"),
    ("MATLAB jacobian", "jacobian", MATLAB_JACOBIAN, "matlab"),
    ("MATLAB gravity", "gravity", MATLAB_GRAVITY, "matlab"),
    ("MATLAB jacobian by transforms", "jacobian", MATLAB_BY_TRANSFORMS, "matlab"),
)
PROGRAMS = [
    Program(f"{name}, {convention}", kind, convention, _signed(text, convention), language)
    for name, kind, text, language in _TEMPLATES
    for convention in ("simscape", "slide")
]
