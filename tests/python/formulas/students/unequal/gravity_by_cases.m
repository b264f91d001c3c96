function tau = gravity(q)
  % the second mass by its distance from the shoulder; the elbow is bent to one side or the other
  a = 0.8; b = 0.21; g = 9.80665;
  d = hypot(a + b*cos(q(3)), b*sin(q(3)));
  inner = atan2(abs(b*sin(q(3))), a + b*cos(q(3)));
  if sin(q(3)) >= 0
    phi = q(2) + inner;
  else
    phi = q(2) - inner;
  end
  t2 = -1.3*g*0.37*cos(q(2)) - 2.1*g*d*cos(phi);
  tau = [0; t2; -2.1*g*b*cos(q(2)+q(3))];
end
