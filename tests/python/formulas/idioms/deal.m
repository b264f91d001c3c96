function G = gravity(q)
[a2, a3] = deal(1);
[m2, m3, g] = deal(0.785, 0.785, 9.80665);
t3 = -m3*g*a3/2*cos(q(2) + q(3));
G = [0; -(m2/2 + m3)*g*a2*cos(q(2)) + t3; t3];
end
