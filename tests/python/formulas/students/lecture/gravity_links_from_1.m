function G = gravity(q)
m1 = 0.785; m2 = 0.785; l1 = 1; l2 = 1; lc1 = l1/2; lc2 = l2/2; g = 9.80665;
G = zeros(3,1);
G(2) = -(m1*lc1 + m2*l1)*g*cos(q(2)) - m2*lc2*g*cos(q(2)+q(3));
G(3) = -m2*lc2*g*cos(q(2)+q(3));
