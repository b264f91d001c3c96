% by projectors of the normal, and without the feedforward written out
function F = command(x, v, x_d, f, f_d)
n = [-1; 0; 0];
S_f = n*n';
e = 500*(x_d - x) - 100*v;
F = e - S_f*e - n*(1.5*f_d - f/2);
