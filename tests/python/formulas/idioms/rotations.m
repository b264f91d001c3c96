function p = tip(q)
R = rotz(q(1))*roty(q(2));
p = R*[1; 0; 0] + R*roty(q(3))*[1; 0; 0];
end
function R = rotz(t)
R = [cos(t) -sin(t) 0; sin(t) cos(t) 0; 0 0 1];
end
function R = roty(t)
R = [cos(t) 0 sin(t); 0 1 0; -sin(t) 0 cos(t)];
end
