function J = jac(q1, q2, q3)
a = [0.8, 0.55];           % lengths
phi = cumulative(q2, q3);
r = a*cos(phi)';
h = dot(a, sin(phi));
J(1,1) = -sin(q1)*r;
J(1,2) = -cos(q1)*h;
J(1,3) = -cos(q1)*a(2)*sin(phi(2));
J(2,1:3) = [cos(q1)*r, -sin(q1)*h, -sin(q1)*a(2)*sin(phi(2))];
J(3,:) = [0, -r, ...
          -a(2)*cos(phi(2))];

function phi = cumulative(x, y)
phi = [x, x + y];
