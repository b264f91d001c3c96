function a = acceleration(x_c, v_c, x_d, f_on_tip)
a = (f_on_tip - 40*v_c - 200*(x_c - x_d))/2;
