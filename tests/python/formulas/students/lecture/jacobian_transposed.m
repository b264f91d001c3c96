function J = jacobian(q)
a = [1 1];
c1 = cos(q(1)); s1 = sin(q(1));
c = [cos(q(2)); cos(q(2)+q(3))];
s = [sin(q(2)); sin(q(2)+q(3))];
Jt = [-s1*(a*c), c1*(a*c), 0
      -c1*(a*s), -s1*(a*s), -a*c
      -c1*a(2)*s(2), -s1*a(2)*s(2), -a(2)*c(2)];
J = Jt';
end
