function p = fk(q)
  p = rotz3(q(1)) * ( ...
        roty3(q(2)) * ([0.8 0 0]' + roty3(q(3))*[0.55 0 0]') ) + [0 0 0.25]';
end
function R = rotz3(t)
  R = [cos(t) -sin(t) 0
       sin(t)  cos(t) 0
       0 0 1];
end
function R = roty3(t), R = [cos(t) 0 sin(t); 0 1 0; -sin(t) 0 cos(t)]; end
