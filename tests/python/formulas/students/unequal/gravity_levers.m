function tau_g = gravity(q)
  m = [1.3 2.1]; lc = [0.37; 0.21]; a2 = 0.8; g = 9.80665;
  phi = cumsum(q(2:3));
  x = [lc(1)*cos(phi(1)); a2*cos(phi(1)) + lc(2)*cos(phi(2))];
  t3 = -m(2)*g*lc(2)*cos(phi(2));
  tau_g = [0; -g*(m*x); t3];
end
