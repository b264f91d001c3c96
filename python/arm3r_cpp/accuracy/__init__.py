"""How exact the runs of a scenario are.

In: a scenario. Out: the observed order of its method, from runs of it with smaller and smaller steps.

The time up to which one run is right comes from the library: `Scenario.run(trust=True)`.
"""
