function G = gravity(q)
unit = 'SI';
switch unit
 case {'SI', 'mks'}
  g = 9.80665;
 case 'US'
  g = 32.174;
 otherwise
  g = 0;
end
a2 = 1; a3 = 1; m2 = 0.785; m3 = 0.785;
t3 = -m3*g*a3/2*cos(q(2) + q(3));
G = [0; -(m2/2 + m3)*g*a2*cos(q(2)) + t3; t3];
end
