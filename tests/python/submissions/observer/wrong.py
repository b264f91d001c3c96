def momentum_rate(tau, c, g, r):
    return tau + c + g + r
