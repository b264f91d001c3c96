function F = command(x, v, x_d, f, f_d)
p = [1; 0; 0];
F = 500*(x_d - x) - 100*v + p*(f_d + 0.5*(f_d - f));
