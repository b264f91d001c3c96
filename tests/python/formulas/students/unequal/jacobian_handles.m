function J = jacobian(q1, q2, q3)
  Rz = @(t) [cos(t), -sin(t), 0; sin(t), cos(t), 0; 0, 0, 1];
  dRz = @(t) [-sin(t), -cos(t), 0; cos(t), -sin(t), 0; 0, 0, 0];
  u = @(t) [cos(t); 0; -sin(t)];
  du = @(t) [-sin(t); 0; -cos(t)];
  arm = 0.8*u(q2) + 0.55*u(q2 + q3);
  J = [dRz(q1)*arm, Rz(q1)*(0.8*du(q2) + 0.55*du(q2 + q3)), Rz(q1)*0.55*du(q2 + q3)];
end
