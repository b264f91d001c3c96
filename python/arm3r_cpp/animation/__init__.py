"""Films of runs: the arm and the wall from the side and from above, with the force and the contact over time.

In comes a finished or partial run. Out goes a GIF, an MP4 or a folder of PNG files, whole or not at all. `animate` has
the public function, `frames` computes the states that are shown, `scene` draws one of them, and `files` writes the
pictures. The modules of this room take colours, forces and the frame of the wall from `plot`. They must not know
command lines, and they never run a scenario.
"""
