function tau = gravity(q)
c2 = cos(q(2)); c23 = cos(q(2)+q(3));
m = [1.3; 2.1]; g = 9.80665;
Jz2 = [0 -0.37*c2 0];
Jz3 = [0 -0.8*c2-0.21*c23 -0.21*c23];
tau = g*[Jz2; Jz3]'*m;
end
