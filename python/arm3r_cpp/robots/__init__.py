"""A user's own arm: from a URDF to the keys of an elbow arm.

In come a URDF and what is said of it: which joints move, at which angles others are locked, where the tip is. Out come
the keys under `arm:` as text, or a whole scenario. `urdf` reads the file, `serial` takes the chain on the way to the
tip, with `bodies` for what hangs on it; `choice` says which joints move, `elbow` measures the chain as an elbow arm,
`remedy` says what would make one of a chain that is none, `explicit` writes the keys, and `start_scenario` a scenario
around them. `arm_bodies` turns resolved keys back into bodies, joints and rotors. Nothing here knows the library's arm:
the keys are all that goes on.
"""
