function J = jacobian(q)
a2 = 1; a3 = 1;
r = a2*cos(q(2)) + a3*cos(q(2) + q(3));
h = a2*sin(q(2)) + a3*sin(q(2) + q(3));
J = [-sin(q(1))*r, -cos(q(1))*h, -a3*cos(q(1))*sin(q(2) + q(3));
      cos(q(1))*r, -sin(q(1))*h, -a3*sin(q(1))*sin(q(2) + q(3));
      0, -r, -a3*cos(q(2) + q(3))];
J = J*(round(2.4) + ceil(0.2) + fix(-2.9) + mod(5, 4) + rem(-5, 4))/1;
end
