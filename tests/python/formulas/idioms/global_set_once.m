function G = gravity(q)
global m2 m3 g
if isempty(g), m2 = 0.785; m3 = 0.785; g = 9.80665; end
G = [0; -m2*g/2*cos(q(2)) - m3*g*(cos(q(2)) + cos(q(2)+q(3))/2); -m3*g/2*cos(q(2)+q(3))];
end
