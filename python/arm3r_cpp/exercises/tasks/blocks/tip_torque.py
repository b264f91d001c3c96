"""The joint torque of a force on the tip: the Jacobian transposed."""

from ...arms import JACOBIAN_LISTING, NUMBERS, lab_arm, times, transposed
from ...task import FunctionTask, Input, Mistake

TASK = FunctionTask(
    name="tip_torque",
    title="from a force to torques",
    text=f"""\
A force f_on_tip, in base axes, acts on the tip. Write the torque that it puts on the joints, as
torque(q, f_on_tip), each a vector of three. The units of the listing are right, its power is not.

{NUMBERS}""",
    hints=(
        "Check the units and the power: f . v must be tau . qd for every motion. What is v in terms of qd?",
        "f . (J qd) = tau . qd for every qd.",
        "tau = J' * f, with J transposed.",
    ),
    given=f"""\
function tau = torque(q, f)
{JACOBIAN_LISTING}tau = J*f;
""",
    function="torque",
    inputs=(Input("q", -3, 3), Input("f_on_tip", -20, 20)),
    entries=("tau1", "tau2", "tau3"),
    right=lambda q, f_on_tip: times(transposed(lab_arm().jacobian(q)), f_on_tip),
    mistakes=(
        Mistake("J is not transposed: it should be J^T f", lambda q, f_on_tip: times(lab_arm().jacobian(q), f_on_tip)),
        Mistake(
            "this is the torque that holds against the force; the force itself puts its opposite on the joints",
            lambda q, f_on_tip: -times(transposed(lab_arm().jacobian(q)), f_on_tip),
        ),
    ),
)
