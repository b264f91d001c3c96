function G = gravity(q)
G = torque(q, numbers());
end
function p = numbers()
p.a2 = 1; p.a3 = 1; p.m2 = 0.785; p.m3 = 0.785; p.g = 9.80665;
end
function G = torque(q, p)
t3 = -p.m3*p.g*p.a3/2*cos(q(2) + q(3));
G = [0; -(p.m2/2 + p.m3)*p.g*p.a2*cos(q(2)) + t3; t3];
end
