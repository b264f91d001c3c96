function G = gravity_matlabfunction(q2,q3)
%GRAVITY_MATLABFUNCTION
%    G = GRAVITY_MATLABFUNCTION(Q2,Q3)
t2 = q2+q3;
t3 = cos(t2);
t4 = t3.*4.32473265;
t5 = -t4;
G = [0.0;t5-cos(q2).*2.1192170650000003e+1;t5];
