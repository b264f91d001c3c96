function G = gravity(q)
persistent p
if isempty(p)
  p = struct('a', [1 1], 'm', [0.785 0.785], 'g', 9.80665);
end
a2 = p.a(1); a3 = p.a(2); m2 = p.m(1); m3 = p.m(2); g = p.g;
t3 = -m3*g*a3/2*cos(q(2) + q(3));
G = [0; -(m2/2 + m3)*g*a2*cos(q(2)) + t3; t3];
end
