"""The joint torque of a force on the tip: the Jacobian transposed."""

from ...arms import arm_of, times, transposed
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="tip_torque",
        title="from a force to torques",
        points=3,
        text=f"""\
A force f_on_tip, in base axes, acts on the tip. Write the torque that it exerts on the joints, as
torque(q, f_on_tip), each a vector of three. The units of the listing are right, its power is not.

{lab.text}""",
        hints=(
            "Check the units and the power: f . v must be tau . qd for every motion. What is v in terms of qd?",
            "f . (J qd) = tau . qd for every qd.",
            "tau = J' * f, with J transposed.",
        ),
        given=f"""\
function tau = torque(q, f)
{lab.jacobian_listing}tau = J*f;
""",
        function="torque",
        inputs=(Input("q", -3, 3), Input("f_on_tip", -20, 20)),
        entries=("tau1", "tau2", "tau3"),
        right=lambda q, f_on_tip: times(transposed(lab.arm.jacobian(q)), f_on_tip),
        mistakes=(
            Mistake("J is not transposed, as in J^T f", lambda q, f_on_tip: times(lab.arm.jacobian(q), f_on_tip)),
            Mistake(
                "this is the torque that balances the force; the torque of the force itself is the opposite",
                lambda q, f_on_tip: -times(transposed(lab.arm.jacobian(q)), f_on_tip),
            ),
        ),
    )
