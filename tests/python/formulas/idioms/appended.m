function J = jacobian(q)
a2 = 1; a3 = 1;
r = a2*cos(q(2)) + a3*cos(q(2) + q(3));
h = a2*sin(q(2)) + a3*sin(q(2) + q(3));
A = [-sin(q(1))*r, -cos(q(1))*h, -a3*cos(q(1))*sin(q(2) + q(3));
      cos(q(1))*r, -sin(q(1))*h, -a3*sin(q(1))*sin(q(2) + q(3));
      0, -r, -a3*cos(q(2) + q(3))];
J = [];
for k = 1:3
  J(:, end+1) = A(:, k);
end
end
