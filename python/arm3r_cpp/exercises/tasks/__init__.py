"""The exercises, a file for each: `formulas` of the arm, `blocks` around it, `scenarios` that run.

Each file is named like its task and holds a function `task`, which makes it for the lab sheet's numbers or those of a
student: its text, what is given, three hints, what is right, and the mistakes that are known. The judges know no task
by name: a new exercise is a new file, and a line below.

They stand in the order of the lab sheet, docs/exercises.md.
"""

from __future__ import annotations

from dataclasses import replace

from ..numbers import LAB, Numbers
from ..task import FunctionTask, Mistake, Task
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

_MAKERS = {
    module.__name__.rpartition(".")[2]: module.task
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


def task_with(name: str, numbers: Numbers) -> Task:
    """The task of this name with these numbers; the lab sheet's are a mistake where others are due."""
    task = replace(_MAKERS[name](numbers), numbers=numbers)
    if numbers.seed is None or not isinstance(task, FunctionTask):
        return task
    lab = task_with(name, LAB)
    assert isinstance(lab, FunctionTask)
    of_all = Mistake("this is right for the lab sheet's numbers, and each student has other ones", lab.right)
    return replace(task, mistakes=(*task.mistakes, of_all))


TASKS = {name: task_with(name, LAB) for name in _MAKERS}
"""By name, with the lab sheet's numbers."""
