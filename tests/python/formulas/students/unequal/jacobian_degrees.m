function [J] = fcn(q1, q2, q3)
% q1, q2, q3 in rad
A2 = 0.8;
A3 = 0.55;
d1 = q1*180/pi; d2 = q2*180/pi; d23 = (q2+q3)*180/pi;
c1 = cosd(d1); s1 = sind(d1);
J = [ -s1*(A2*cosd(d2)+A3*cosd(d23)), -c1*(A2*sind(d2)+A3*sind(d23)), -c1*A3*sind(d23)
       c1*(A2*cosd(d2)+A3*cosd(d23)), -s1*(A2*sind(d2)+A3*sind(d23)), -s1*A3*sind(d23)
       0,                              A2*cosd(d2)+A3*cosd(d23),        A3*cosd(d23) ];
