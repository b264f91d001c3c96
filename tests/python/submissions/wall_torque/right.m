function tau = torque(q, f_on_wall)
a2 = 0.8; a3 = 0.6;
r = a2*cos(q(2)) + a3*cos(q(2)+q(3));
h = a2*sin(q(2)) + a3*sin(q(2)+q(3));
s = a3*sin(q(2)+q(3));
J = [-sin(q(1))*r, -cos(q(1))*h, -cos(q(1))*s; cos(q(1))*r, -sin(q(1))*h, -sin(q(1))*s; 0, -r, -a3*cos(q(2)+q(3))];
tau = -J'*f_on_wall;
