function dJ = jacobian_dot(q, qd)
  % d/dt of the columns z x r
  a2 = 0.8; a3 = 0.55;
  k = [0; 0; 1];
  e = [cos(q(1)); sin(q(1)); 0]; n = cross(k, e);
  de = qd(1)*n; dn = -qd(1)*e;
  p2 = a2*(cos(q(2))*e - sin(q(2))*k);
  p3 = a3*(cos(q(2)+q(3))*e - sin(q(2)+q(3))*k);
  dp2 = a2*(cos(q(2))*de - qd(2)*(sin(q(2))*e + cos(q(2))*k));
  dp3 = a3*(cos(q(2)+q(3))*de - (qd(2)+qd(3))*(sin(q(2)+q(3))*e + cos(q(2)+q(3))*k));
  dJ = [cross(k, dp2 + dp3), cross(dn, p2 + p3) + cross(n, dp2 + dp3), cross(dn, p3) + cross(n, dp3)];
end
