def wall_force(x, x_E):
    d = x[0] - x_E[0]
    return (1000 * d, 0, 0, 1) if d > 0 else (0, 0, 0, 0)
