function tau = gravity(q)
% each link's weight in a loop of its own
m = [0 0.785 0.785]; a = [0 1 1]; g = 9.80665;
angles = cumsum([0; q(2); q(3)]);
part = zeros(3, 3);
parfor (i = 2:3, 4)
  row = zeros(3, 1);
  row(2:i) = -m(i)*g*a(i)/2*cos(angles(i));
  if i == 3, row(2) = row(2) - m(3)*g*a(2)*cos(q(2)); end
  part(:, i) = row;
end
fprintf('%s\n', sprintf('%8.3f', part));
tau = sum(part, 2);
end
