% nearly no torque is not no torque
function [t3, t2, t1] = fcn(q3, q2, q1)
a2 = 0.8; a3 = 0.6; m2 = 1.2; m3 = 0.7; g = 9.80665;
t1 = 0.01*q1;
t3 = -m3*g*(a3/2)*cos(q2+q3);
t2 = -m2*g*(a2/2)*cos(q2) - m3*g*a2*cos(q2) + t3;
