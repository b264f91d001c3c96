% the lecture's style, with the error the other way round and the sign outside
function tau = controller(q, qd)
a2 = 0.8; a3 = 0.6; m2 = 1.2; m3 = 0.7; g = 9.80665;
x_d = [0.9; 0.2; 0.3];
r = a2*cos(q(2)) + a3*cos(q(2)+q(3));
h = a2*sin(q(2)) + a3*sin(q(2)+q(3));
s = a3*sin(q(2)+q(3));
J = [-sin(q(1))*r, -cos(q(1))*h, -cos(q(1))*s; cos(q(1))*r, -sin(q(1))*h, -sin(q(1))*s; 0, -r, -a3*cos(q(2)+q(3))];
x = [cos(q(1))*r; sin(q(1))*r; -h];
t3 = -m3*g*(a3/2)*cos(q(2)+q(3));
t2 = -(m2/2 + m3)*g*a2*cos(q(2)) + t3;
tau = [0; t2; t3] - J'*(300*(x - x_d) + 40*J*qd);
