function p = fcn(q1, q2, q3)
a2 = 0.8; a3 = 0.6;
r = a2*cos(q2) + a3*cos(q2+q3);
p = [r*cos(q1); r*sin(q1); -a2*sin(q2) - a3*sin(q2+q3)];
end
