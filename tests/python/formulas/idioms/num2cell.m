function G = gravity(q)
c = num2cell(q);
[q1, q2, q3] = c{:};
axis = [0.785, 9.80665];
axis(1) = axis(1) + 0*q1;
grid = axis(2);
switch lower('SI')
  case'si'
    t3 = -axis(1)*grid/2*cos(q2 + q3);
end
G = [0; -1.5*axis(1)*grid*cos(q2) + t3; t3];
end
