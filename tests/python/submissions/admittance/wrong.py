def acceleration(x_c, v_c, x_d, f):
    return (f - 40 * v_c - 200 * (x_d - x_c)) / 2
