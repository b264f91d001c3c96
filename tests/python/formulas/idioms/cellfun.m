function G = gravity(q)
a2 = 1; a3 = 1; m2 = 0.785; m3 = 0.785; g = 9.80665;
angles = {q(2), q(2) + q(3)};
c = cellfun(@(x) cos(x), angles);
C = cellfun(@cos, angles, 'UniformOutput', false);
t3 = -m3*g*a3/2*c(2);
G = [0; -(m2/2 + m3)*g*a2*C{1} + t3; t3];
end
