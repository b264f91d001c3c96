function J = jacobian(theta)
  % rotation matrices and skew-symmetric products
  a2 = 0.8; a3 = 0.55;
  R1 = rotz(theta(1));
  R2 = R1*roty(theta(2));
  R3 = R2*roty(theta(3));
  r3 = a3*R3(:,1);
  r2 = a2*R2(:,1) + r3;
  J = [skew(R1(:,3))*r2 skew(R1(:,2))*r2 skew(R1(:,2))*r3];
end

function R = rotz(t)
  R = [cos(t) -sin(t) 0; sin(t) cos(t) 0; 0 0 1];
end

function R = roty(t)
  R = [cos(t) 0 sin(t); 0 1 0; -sin(t) 0 cos(t)];
end

function S = skew(v)
  S = [0 -v(3) v(2); v(3) 0 -v(1); -v(2) v(1) 0];
end
