function p = tip(q)
S1 = [0 0 1]; S2 = [0 1 0];
M = [2; 0; 0];
p = rot(S1, q(1))*(rot(S2, q(2))*([1; 0; 0] + rot(S2, q(3))*(M - [1; 0; 0])));
end
function R = rot(w, t)
W = [0 -w(3) w(2); w(3) 0 -w(1); -w(2) w(1) 0];
R = eye(3) + sin(t)*W + (1 - cos(t))*W^2;
end
