function qdd = forward_dynamics(q, qd, tau)
  % M qdd = tau - h - G
  [A, B, C] = constants();
  c2 = cos(q(2)); c23 = cos(q(2)+q(3));
  s2 = sin(q(2)); s23 = sin(q(2)+q(3));
  M = [1.3083333333333334e-05 + 0.002*s2^2 + 0.003*s23^2 + A*c2^2 + B*c23^2 + 2*C*c2*c23, 0, 0
       0, A + B + 2*C*cos(q(3)), B + C*cos(q(3))
       0, B + C*cos(q(3)), B];
  d2 = 2*(0.002 - A)*s2*c2 - 2*C*s2*c23;
  d3 = 2*(0.003 - B)*s23*c23 - 2*C*c2*s23;
  w = qd(2) + qd(3);
  s3 = sin(q(3));
  h = [ qd(1)*(d2*qd(2) + d3*w)
       -0.5*qd(1)^2*(d2 + d3) - C*s3*qd(3)*(2*qd(2) + qd(3))
       -0.5*qd(1)^2*d3 + C*s3*qd(2)^2 ];
  g = 9.80665;
  G = -g*[0; (1.3*0.37 + 2.1*0.8)*c2 + 2.1*0.21*c23; 2.1*0.21*c23];
  qdd = inv(M)*(tau - h - G);
end

function [A, B, C] = constants()
  A = 0.071 + 1.3*0.37^2 + 2.1*0.8^2;
  B = 0.043 + 2.1*0.21^2;
  C = 2.1*0.8*0.21;
end
