"""Sweeps: many runs of one scenario, from a file into a folder that holds one table.

In comes the YAML file of a sweep, or a map of the same keys. Out goes a folder with the table and with the shards that
it was merged from. `definition` has what the library reads in the file, and `axes` computes the values of each run.
`runner` gives the shards to an executor, `shard` computes one of them, `folder` keeps what is finished, `table` reads
the result, and `table_io` turns tables into bytes. The modules of this room must not know figures or command lines, and
a shard must not know the folder: a worker on another machine gets text and numbers only.
"""
