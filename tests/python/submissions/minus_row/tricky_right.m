% six rows, by cross products of the joints' axes
function J = geometric(q)
a2 = 0.8; a3 = 0.6;
u = [cos(q(1)); sin(q(1)); 0];
k = [0; 0; 1];
y = [-sin(q(1)); cos(q(1)); 0];
elbow = a2*(cos(q(2))*u - sin(q(2))*k);
tip = elbow + a3*(cos(q(2)+q(3))*u - sin(q(2)+q(3))*k);
J = [cross(k, tip), cross(y, tip), cross(y, tip - elbow); k, y, y];
end
