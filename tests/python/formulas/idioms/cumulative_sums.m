function J = jacobian(q)
% positions of the joints from cumulative sums of the angles
L = [1 1];
t = cumsum(q(2:3));
x = L.*cos(t(:)');
z = L.*sin(t(:)');
r = fliplr(cumsum(fliplr(x)));
h = fliplr(cumsum(fliplr(z)));
u = [cos(q(1)); sin(q(1)); 0];
n = [-sin(q(1)); cos(q(1)); 0];
J = [n*r(1), -u*h(1) + [0;0;1]*r(1), -u*h(2) + [0;0;1]*r(2)];
J = [J(:,1), J(:,2), J(:,3)];
J(3,2:3) = -J(3,2:3);
end
