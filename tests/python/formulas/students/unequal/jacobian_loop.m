function J = jacobian(q)
  % DH frames in a cell array
  a = [0 0.8 0.55]; alpha = [-pi/2 0 0]; d = [0.25 0 0];
  T = cell(1,4);
  T{1} = eye(4);
  for i = 1:3
    ct = cos(q(i)); st = sin(q(i)); ca = cos(alpha(i)); sa = sin(alpha(i));
    T{i+1} = T{i}*[ct -st*ca st*sa a(i)*ct; st ct*ca -ct*sa a(i)*st; 0 sa ca d(i); 0 0 0 1];
  end
  J = zeros(3,3);
  for i = 1:3
    z = T{i}(1:3,3);
    J(:,i) = cross(z, T{4}(1:3,4) - T{i}(1:3,4));
  end
end
