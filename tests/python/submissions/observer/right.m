function s_dot = momentum_rate(tau, c, g, r)
s_dot = tau + c - g + r;
