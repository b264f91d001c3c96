function M = fcn(q1, q2, q3)
a2 = 0.8; a3 = 0.6; m2 = 1.2; m3 = 0.7; I1 = 0.05;
A = m2*a2^2/3 + m3*a2^2;
B = m3*a2*a3/2;
C = m3*a3^2/3;
m11 = I1 + A*cos(q2)^2 + C*cos(q2+q3)^2 + 2*B*cos(q2)*cos(q2+q3);
m23 = C + B*cos(q3);
M = [m11 0 0; 0 A + C + 2*B*cos(q3) m23; 0 m23 C];
