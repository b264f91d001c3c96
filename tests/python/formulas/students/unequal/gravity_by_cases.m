function tau = gravity(q)
  % the lever by the law of cosines, where the elbow is bent to one side or the other
  a = 0.8; b = 0.21; g = 9.80665;
  d = sqrt(a^2 + b^2 + 2*a*b*cos(q(3)));
  inner = acos(min(max((a^2 + d^2 - b^2)/(2*a*d), -1), 1));
  if sin(q(3)) >= 0
    phi = q(2) + inner;
  else
    phi = q(2) - inner;
  end
  t2 = -1.3*g*0.37*cos(q(2)) - 2.1*g*d*cos(phi);
  tau = [0; t2; -2.1*g*b*cos(q(2)+q(3))];
end
