"""Rows of runs: names of columns, and the rows of many runs in one block of memory.

In come names as users write them, and the memory that the library filled. Out go the places of columns as the library
numbers them, and arrays by name. `names` says which columns a name stands for, `batch_rows` holds the rows of a batch.
The modules of this room know the library through `_native` only; they know no scenario.
"""
