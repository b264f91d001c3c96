function J = fcn(u)
%#codegen
%{
   u = [q1 q2 q3]'
%}
q1 = u(1); q2 = u(2); q3 = u(3);
L2 = 1; L3 = 1;
J = [ ...
    -sin(q1)*(L2*cos(q2) + L3*cos(q2 + q3)), -cos(q1)*(L2*sin(q2) + L3*sin(q2 + q3)), -L3*cos(q1)*sin(q2 + q3); ...
     cos(q1)*(L2*cos(q2) + L3*cos(q2 + q3)), -sin(q1)*(L2*sin(q2) + L3*sin(q2 + q3)), -L3*sin(q1)*sin(q2 + q3); ...
     0, -(L2*cos(q2) + L3*cos(q2 + q3)), -L3*cos(q2 + q3)];
end
