% without `if`: |d| + d is 2d inside and 0 outside
function out = wall_force(x, x_E)
d = x(1) - x_E(1);
out = [-500*(abs(d) + d), 0, 0, (1 + sign(d))/2];
