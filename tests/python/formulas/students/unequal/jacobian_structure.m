function J = jacobian(q)
  arm = parameters();
  J = columns(arm, q);
end

function p = parameters()
  p.a2 = 0.8;
  p.a3 = 0.55;
end

function J = columns(p, q)
  c1 = cos(q(1)); s1 = sin(q(1));
  c2 = cos(q(2)); s2 = sin(q(2));
  c23 = cos(q(2)+q(3)); s23 = sin(q(2)+q(3));
  r = p.a2*c2 + p.a3*c23;
  h = p.a2*s2 + p.a3*s23;
  J = [-s1*r, -c1*h, -p.a3*c1*s23
        c1*r, -s1*h, -p.a3*s1*s23
        0,    -r,    -p.a3*c23];
end
