function M = mass_matrix(q)
  M = zeros(3,3);
  c1 = cos(q(1)); s1 = sin(q(1));
  n = [-s1; c1; 0]; k = [0;0;1];
  u2 = [c1*cos(q(2)); s1*cos(q(2)); -sin(q(2))];
  u3 = [c1*cos(q(2)+q(3)); s1*cos(q(2)+q(3)); -sin(q(2)+q(3))];
  p2 = 0.37*u2; e = 0.8*u2; p3 = e + 0.21*u3;
  Jv2 = [cross(k,p2) cross(n,p2) zeros(3,1)];
  Jv3 = [cross(k,p3) cross(n,p3) cross(n,p3-e)];
  Jw2 = [k n zeros(3,1)]; Jw3 = [k n n];
  R2 = [u2 n cross(u2,n)]; R3 = [u3 n cross(u3,n)];
  I2 = R2*diag([0.002 0.071 0.071])*R2';
  I3 = R3*diag([0.003 0.043 0.043])*R3';
  M = 1.3*(Jv2'*Jv2) + 2.1*(Jv3'*Jv3) + Jw2'*I2*Jw2 + Jw3'*I3*Jw3;
  M(1,1) = M(1,1) + 1.3083333333333334e-05;
end
