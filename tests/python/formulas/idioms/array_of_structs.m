function G = gravity(q)
L(2).a = 1; L(3).a = 1;
L(2).m = 0.785; L(3).m = 0.785;
g = 9.80665;
a2 = L(2).a; a3 = L(3).a; m2 = L(2).m; m3 = L(3).m;
t3 = -m3*g*a3/2*cos(q(2) + q(3));
G = [0; -(m2/2 + m3)*g*a2*cos(q(2)) + t3; t3];
end
