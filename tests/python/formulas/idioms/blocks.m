function J = jacobian(q)
c = @(t) cos(t); s = @(t) sin(t);
Rz = blkdiag([c(q(1)) -s(q(1)); s(q(1)) c(q(1))], 1);
r = [c(q(2)) + c(q(2)+q(3)); 0; -s(q(2)) - s(q(2)+q(3))];
dr2 = [r(3); 0; -r(1)];
dr3 = [-s(q(2)+q(3)); 0; -c(q(2)+q(3))];
dRz = [-s(q(1)) -c(q(1)) 0; c(q(1)) -s(q(1)) 0; 0 0 0];
J = horzcat(dRz*r, Rz*dr2, Rz*dr3);
end
