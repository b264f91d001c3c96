function qdd = forward_dynamics(q, qd, tau)
  A = 0.071 + 1.3*0.37^2 + 2.1*0.8^2; B = 0.043 + 2.1*0.21^2; C = 2.1*0.8*0.21;
  q2 = q(2); q3 = q(3);
  M11 = 1.3083333333333334e-05 + 0.002*sin(q2)^2 + 0.003*sin(q2+q3)^2 + A*cos(q2)^2 + B*cos(q2+q3)^2 + 2*C*cos(q2)*cos(q2+q3);
  M = [M11 0 0; 0 A+B+2*C*cos(q3) B+C*cos(q3); 0 B+C*cos(q3) B];
  d2 = (0.002 - A)*sin(2*q2) + (0.003 - B)*sin(2*(q2+q3)) - 2*C*sin(2*q2+q3);
  d3 = (0.003 - B)*sin(2*(q2+q3)) - 2*C*cos(q2)*sin(q2+q3);
  h = [qd(1)*(d2*qd(2) + d3*qd(3)); -d2/2*qd(1)^2 - C*sin(q3)*(2*qd(2)+qd(3))*qd(3); -d3/2*qd(1)^2 + C*sin(q3)*qd(2)^2];
  G = -9.80665*[0; (1.3*0.37+2.1*0.8)*cos(q2) + 2.1*0.21*cos(q2+q3); 2.1*0.21*cos(q2+q3)];
  qdd = M\(tau - h - G);
end
