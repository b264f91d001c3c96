"""The joint torque that belongs to a force measured on the wall."""

from ...arms import arm_of, times, transposed
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="wall_torque",
        title="a sensor in the wall",
        points=3,
        text=f"""\
A sensor in the wall measures f_on_wall, the lecture's K_E (x - x_E), in base axes. Write the torque that
the contact exerts on the arm's joints, as torque(q, f_on_wall), each a vector of three. In a simulation
with the listing, the wall pulls the arm in.

{lab.text}""",
        hints=(
            "The tip presses on the wall with f_on_wall. With which force does the wall press on the tip?",
            "Action and reaction: f_on_tip = -f_on_wall. The joints feel J^T f_on_tip.",
            "tau = -J' * f_on_wall.",
        ),
        given=f"""\
function tau = torque(q, f)
{lab.jacobian_listing}tau = J'*f;
""",
        function="torque",
        inputs=(Input("q", -3, 3), Input("f_on_wall", -20, 20)),
        entries=("tau1", "tau2", "tau3"),
        right=lambda q, f_on_wall: -times(transposed(lab.arm.jacobian(q)), f_on_wall),
        mistakes=(
            Mistake(
                "this takes f_on_wall for the force on the tip; the tip feels its opposite",
                lambda q, f_on_wall: times(transposed(lab.arm.jacobian(q)), f_on_wall),
            ),
            Mistake("J is not transposed, as in -J^T f", lambda q, f_on_wall: -times(lab.arm.jacobian(q), f_on_wall)),
            Mistake(
                "J is not transposed, and the sign is that of a force on the tip",
                lambda q, f_on_wall: times(lab.arm.jacobian(q), f_on_wall),
            ),
        ),
    )
