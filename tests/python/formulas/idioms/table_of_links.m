function G = gravity(q)
links = struct('m', {0.785, 0.785}, 'l', {1, 1});
g = 9.80665;
G = zeros(3, 1);
for i = 1:numel(links)
    for j = 1:i
        lever = 0;
        for k = j:i
            part = 1;
            if k == i, part = 0.5; end
            lever = lever + part*links(k).l*cos(sum(q(2:k + 1)));
        end
        G(j + 1) = G(j + 1) - links(i).m*g*lever;
    end
end
end
