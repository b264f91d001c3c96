function G = gravity(q)
c = {1, 1, 'kg', 0.785, 0.785};
[a2, a3] = c{1:2};
m = [c{4:5}];
m2 = m(1); m3 = m(end);
g = 9.80665;
t3 = -m3*g*a3/2*cos(q(2) + q(3));
G = [0; -(m2/2 + m3)*g*a2*cos(q(2)) + t3; t3];
end
