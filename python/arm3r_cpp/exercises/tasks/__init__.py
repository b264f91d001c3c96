"""The exercises, a file for each: `formulas` of the arm, `blocks` around it, `scenarios` that run.

Each file holds one `TASK`: its text, what is given, three hints, what is right, and the mistakes that are known. The
judges know no task by name: a new exercise is a new file, and a line below.

They stand in the order of the lab sheet, docs/exercises.md.
"""

from __future__ import annotations

from ..task import Task
from .blocks import (
    admittance,
    degrees,
    hybrid_selection,
    observer,
    reversed_arguments,
    tip_torque,
    wall_force,
    wall_torque,
)
from .formulas import first_joint, half_link, impedance, mass_matrix, minus_row, tip_position
from .scenarios import force_on_arm, gravity_constant, moon, plate_face, steady_force

TASKS: dict[str, Task] = {
    module.TASK.name: module.TASK
    for module in (
        # the arm
        tip_position,
        minus_row,
        degrees,
        tip_torque,
        mass_matrix,
        # its weight
        first_joint,
        half_link,
        reversed_arguments,
        gravity_constant,
        moon,
        # the wall
        wall_force,
        plate_face,
        wall_torque,
        force_on_arm,
        # control
        impedance,
        admittance,
        hybrid_selection,
        steady_force,
        observer,
    )
}
"""By name."""
