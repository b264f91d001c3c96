def momentum_rate(a_, b_, c_, d_):
    """The arguments by position, whatever they are called."""
    return [a - (d - b - e) for a, b, d, e in zip(a_, b_, c_, d_, strict=True)]
