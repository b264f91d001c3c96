function G = gravity(q)
t3 = torque(q);
[same, arm] = torque(q);
G = [0; -1.5*0.785*9.80665*cos(q(2)) + t3; (t3 + same*arm)/2];
end

function [t, arm] = torque(q)
t = -0.785*9.80665/2*cos(q(2) + q(3));
if nargout > 1
  arm = 1;
end
end
