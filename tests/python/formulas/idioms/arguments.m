function G = gravity(q, g)
arguments
  q (3,1) double {mustBeReal} % rad
  g (1,1) double = 9.80665
end
a2 = 1; a3 = 1; m2 = 0.785; m3 = 0.785;
t3 = -m3*g*a3/2*cos(q(2) + q(3));
G = [0; -(m2/2 + m3)*g*a2*cos(q(2)) + t3; t3];
end
