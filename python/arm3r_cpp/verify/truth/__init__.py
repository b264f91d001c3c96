"""What is right: the arm that a user's formula is compared with.

In come a scenario, a parameter array, or the description of a serial chain. Out come the numbers that a formula must
return at given states. `three_r` asks the C++ functions for a scenario's planar arm, in either convention. `chain`
computes any serial chain of up to seven joints by an outward and inward Newton-Euler recursion in numpy, which shares
nothing with the closed forms; `elbow` has that of a scenario's elbow arm. `dh` reads chains from tables, the room
`robots` from URDF files, and `chain_files` binds them together. This room must not know the user's programs.
"""
