function p = kinematics(q)
  Rz = @(t) [cos(t) -sin(t) 0; sin(t) cos(t) 0; 0 0 1];
  Ry = @(t) [cos(t) 0 sin(t); 0 1 0; -sin(t) 0 cos(t)];
  p = [0; 0; 0.25] + Rz(q(1))*(Ry(q(2))*[0.8; 0; 0] + Ry(q(2)+q(3))*[0.55; 0; 0]);
end
