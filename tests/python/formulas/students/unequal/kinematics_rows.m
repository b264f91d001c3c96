function p = tip(q1, q2, q3)
% row vectors, multiplied from the right
Rz = [cos(q1) sin(q1) 0; -sin(q1) cos(q1) 0; 0 0 1];
Ry = @(t) [cos(t) 0 -sin(t); 0 1 0; sin(t) 0 cos(t)];
p = ([0.8 0 0]*Ry(q2) + [0.55 0 0]*Ry(q2+q3))*Rz + [0 0 0.25];
p = p.';
end
