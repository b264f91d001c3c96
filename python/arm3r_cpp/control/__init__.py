"""Control laws that users write, for a run or for each run of a batch, and the limit of the time that a run may take.

In comes the handle of a scenario with a law: a Python function of time and state, or the address of a function in
machine code. Out goes the run, or an error that names the tick at which the law failed and what it returned.
`law` calls the function at each sample, `batch_law` does so in the runs of a batch, `law_state` is what the function
sees, and `time_limit` ends a function that does not return. The modules of this room know the library through `_native`
only. They must not know how a scenario is read or changed, and they never compute a torque themselves.
"""
