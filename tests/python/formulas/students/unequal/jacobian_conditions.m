function J = jacobian(q)
  L = [0.8 0.55];
  J = zeros(3);
  for j = 1:3
    for k = max(j-1, 1):2
      t = sum(q(2:k+1));
      if j == 1
        J(:,1) = J(:,1) + L(k)*cos(t)*[-sin(q(1)); cos(q(1)); 0];
      elseif j == 2 || k == 2
        J(:,j) = J(:,j) - L(k)*[cos(q(1))*sin(t); sin(q(1))*sin(t); cos(t)];
      else
        J(:,j) = NaN;
      end
    end
  end
end
