function G = gravity(q)
p = struct('a2', 1, 'a3', 1, 'g', 9.80665);
p.m2 = 0.785;
p.m3 = p.m2;
a2 = p.a2; a3 = p.a3; m2 = p.m2; m3 = p.m3; g = p.g;
t3 = -m3*g*a3/2*cos(q(2) + q(3));
G = [0; -(m2/2 + m3)*g*a2*cos(q(2)) + t3; t3];
end
