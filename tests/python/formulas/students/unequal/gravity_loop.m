function tau = gravity(q)
m = [1.3 2.1]; g = 9.80665; arms = [0.37 0; 0.8 0.21];
tau = zeros(3,1);
for b = 1:2
    for j = 2:3
        for k = j-1:2
            tau(j) = tau(j) - m(b)*g*arms(b,k)*cos(sum(q(2:k+1)));
        end
    end
end
end
