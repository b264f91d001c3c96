function tau = gravity(q)
  g = 9.80665;
  m2 = 1.3;  m3 = 2.1;
  R = [cos(q(1)) -sin(q(1)) 0; sin(q(1)) cos(q(1)) 0; 0 0 1];
  d2 = [-sin(q(2)); 0; -cos(q(2))];
  d3 = [-sin(q(2)+q(3)); 0; -cos(q(2)+q(3))];
  J2 = R*[zeros(3,1), 0.37*d2, zeros(3,1)];
  J3 = R*[zeros(3,1), 0.8*d2 + 0.21*d3, 0.21*d3];
  F = [0 0 g]';
  tau = J2'*(m2*F) + J3'*(m3*F);
end
