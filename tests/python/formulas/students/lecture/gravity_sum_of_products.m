function [tau1, tau2, tau3] = gravity(q1, q2, q3)
% mass matrix of the lecture's slides, g pointing down
m2 = 0.785; m3 = 0.785; g0 = 9.80665; l2 = 1; l3 = 1;
S = [m2*l2/2 + m3*l2, m3*l3/2];
C = [cos(q2); cos(q2+q3)];
tau1 = 0*q1;
tau2 = -g0*S*C;
tau3 = -g0*S(2)*C(2);
end
