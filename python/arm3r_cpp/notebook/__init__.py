"""How runs, batches and scenarios are shown in a notebook, and handed to pandas and xarray.

In comes a Run, a Batch or a Scenario. Out goes a page of HTML with a summary, the checks and a small figure, or a table
of another library. `pages` says what a page holds, `html` writes it with every text escaped, `small_figure` draws
outside pyplot, and `tables` makes the objects of pandas and xarray, which are imported there and nowhere else.
The modules of this room never run a scenario, and nothing here is imported before it is asked for.
"""
