function J = jacobian(q)
  % Jacobi-Matrix, Spalten einzeln
  l2 = 0.8; l3 = 0.55;
  e = [cos(q(1)) sin(q(1)) 0]';
  n = [-sin(q(1)); cos(q(1)); 0];
  k = [0 0 1]';
  p2 = l2*(cos(q(2))*e - sin(q(2))*k);
  p3 = l3*(cos(q(2)+q(3))*e - sin(q(2)+q(3))*k);
  J = zeros(3,3);
  J(:,1) = cross(k, p2 + p3);
  J(:,2) = cross(n, p2 + p3);
  J(:,3) = cross(n, p3);
end
