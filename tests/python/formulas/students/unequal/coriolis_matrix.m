function C = coriolis(q, qd)
A = 0.069 + 1.3*0.37^2 + 2.1*0.8^2;
B = 0.040 + 2.1*0.21^2;
k = 2.1*0.8*0.21;
s2 = sin(q(2)); c2 = cos(q(2)); s23 = sin(q(2)+q(3)); c23 = cos(q(2)+q(3));
h2 = -A*s2*c2 - B*s23*c23 - k*sin(2*q(2)+q(3));
h3 = -B*s23*c23 - k*c2*s23;
b = k*sin(q(3));
C = [h2*qd(2)+h3*qd(3), h2*qd(1), h3*qd(1);
    -h2*qd(1), -b*qd(3), -b*(qd(2)+qd(3));
    -h3*qd(1), b*qd(2), 0];
end
