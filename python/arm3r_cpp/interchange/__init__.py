"""A scenario's arm for other programs: URDF and MJCF.

In comes a scenario. Out goes an XML file with the same three bodies and joints, whose joint angles are those of
`arm.convention`. `urdf` and `mjcf` write the bodies, joints and rotors of the arm down, `wall` adds the wall to MJCF,
and `export` writes the file. What a format cannot say exactly is refused, or
left out with a warning. These modules must not know command lines.
"""
