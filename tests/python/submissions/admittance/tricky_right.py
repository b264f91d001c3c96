def acceleration(x_c, v_c, x_d, f_on_tip):
    """Axis by axis, in lists."""
    return [f / 2 - 20 * v + 100 * (d - x) for x, v, d, f in zip(x_c, v_c, x_d, f_on_tip, strict=True)]
