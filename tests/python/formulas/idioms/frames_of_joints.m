function J = jacobian(q)
[p, z] = frames(q);
J = zeros(3);
for i = 1:3
    J(:, i) = cross(z(:, i), p(:, 4) - p(:, i));
end
end
function [p, z] = frames(q)
T = eye(4);
p = zeros(3, 4); z = zeros(3, 3);
dh = [0 -pi/2 0; 1 0 0; 1 0 0];
for i = 1:3
    z(:, i) = T(1:3, 3);
    p(:, i) = T(1:3, 4);
    T = T*link(q(i), dh(i, 1), dh(i, 2), dh(i, 3));
end
p(:, 4) = T(1:3, 4);
end
function A = link(theta, a, alpha, d)
ct = cos(theta); st = sin(theta);
A = [ct, -st*cos(alpha),  st*sin(alpha), a*ct
     st,  ct*cos(alpha), -ct*sin(alpha), a*st
     0,   sin(alpha),     cos(alpha),    d
     0,   0,              0,             1];
end
