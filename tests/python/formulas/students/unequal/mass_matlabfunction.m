function M = mass_matlabfunction(in1)
%MASS_MATLABFUNCTION
%    M = MASS_MATLABFUNCTION(IN1)
q2 = in1(2,:);
q3 = in1(3,:);
t2 = cos(q2);
t3 = cos(q3);
t4 = q2+q3;
t5 = t2.^2;
t6 = cos(t4);
t7 = t3.*3.528e-1;
t8 = t6.^2;
t9 = t7+1.3561e-1;
mt1 = [t5.*1.59097+t8.*1.3261e-1+t2.*t6.*7.056e-1+5.0130833333333e-3,0.0,0.0,0.0,t3.*7.056e-1+1.72858,t9];
mt2 = [0.0,t9,1.3561e-1];
M = reshape([mt1,mt2],3,3);
end
