"""The reference of the force-control benchmarks: a small simulator of its own, its control laws, closed forms.

Nothing of arm3r is used, scipy integrates. Convention: slide (positive q2, q3 raise the arm). SI units, radians, world
axes. A force with three components is that on the tip; f >= 0 is what the wall feels along its inward normal p_in.
"""

from __future__ import annotations

from . import estimation, held, impact, laws, linear, sampled, statics
from .arm import Arm, G, Motion
from .scenario import control_of, run_of, wall_of
from .settings import LECTURE_CONTACT, QA, SETTINGS, XA, varied
from .simulator import CONTACT, FREE, SEPARATED, Run, residual, simulate, simulate_delayed, simulate_sampled
from .wall import Wall, hunt_crossley, kelvin_voigt, spring

__all__ = [
    "CONTACT",
    "FREE",
    "LECTURE_CONTACT",
    "QA",
    "SEPARATED",
    "SETTINGS",
    "XA",
    "Arm",
    "G",
    "Motion",
    "Run",
    "Wall",
    "control_of",
    "estimation",
    "held",
    "hunt_crossley",
    "impact",
    "kelvin_voigt",
    "laws",
    "linear",
    "residual",
    "run_of",
    "sampled",
    "simulate",
    "simulate_delayed",
    "simulate_sampled",
    "spring",
    "statics",
    "varied",
    "wall_of",
]
