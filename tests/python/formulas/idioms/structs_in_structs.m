function G = gravity(q)
arm.link.a = [1 1];
arm.link.m = [0.785, 0.785];
arm.world = struct('g', 9.80665);
a2 = arm.link.a(1); a3 = arm.link.a(2); m2 = arm.link.m(1); m3 = arm.link.m(2); g = arm.world.g;
t3 = -m3*g*a3/2*cos(q(2) + q(3));
G = [0; -(m2/2 + m3)*g*a2*cos(q(2)) + t3; t3];
end
