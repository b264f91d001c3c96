"""Names that people try because other programs have them, and what they are called here.

docs/from_simulink.md lists some of them for people. Names of a scenario's keys and words are the library's own.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from .._messages import did_you_mean

_THREE_JOINTS = (
    "an arm has three joints, those of a URDF with Arm.from_urdf(path); verify.Chain.from_urdf and from_dh describe "
    "other chains, for formulas"
)

# By the class or module: names, parted by blanks, and what to write instead.
_TABLE: dict[str, dict[str, str]] = {
    "arm3r_cpp": {
        "load loadmat read open load_yaml read_yaml read_csv load_csv load_run": (
            "Scenario.load(path) or Run.load(path)"
        ),
        "simulate sim run ode45 solve solve_ivp odeint set_param": "Scenario.load(path).run()",
        "parsim run_batch many": "scenario.batch({...})",
        "linmod linearize ss": "scenario.arm.linearize(q, qd, tau)",
        "PID pid Controller": 'scenario["controller"] = {"type": "joint_pd"}, or scenario.run(controller=f)',
        "overview lecture compare force animate scope": "plot.overview(run), plot.lecture, plot.compare, plot.force",
        "example load_example": 'Scenario.example("moving_wall")',
        "Robot SerialLink DHRobot loadrobot importrobot rigidBodyTree from_urdf": "Arm.from_urdf(path)",
    },
    "Arm": {
        "fkine fk forward_kinematics tip": "tip_position(q)",
        "ikine ik ikine_LM": "inverse_kinematics(p)",
        "jacob0 jac J": "jacobian(q)",
        "geometricJacobian jacobian_6": "geometric_jacobian(q)",
        "inertia crba massMatrix M": "mass_matrix(q)",
        "coriolis C": "coriolis_matrix(q, qd)",
        "velocityProduct": "velocity_product(q, qd)",
        "gravload gravityTorque gravity G g": "gravity_torque(q)",
        "rne rnea inverseDynamics": "inverse_dynamics(q, qd, qdd)",
        "accel aba forwardDynamics fdyn": "forward_dynamics(q, qd, tau)",
        "maniplty": "manipulability(q)",
        "jacob_dot Jdot": "jacobian_dot(q, qd)",
        "linmod ss": "linearize(q, qd, tau)",
        "joints links dof n nq numjoints njoints from_dh": _THREE_JOINTS,
        "urdf load importrobot": "Arm.from_urdf(path)",
        "mass masses length lengths a2 a3 m2 m3": 'scenario["arm.link2.mass"], scenario["arm.link2.length"] ...',
        "run simulate": "Scenario().run(): an arm moves in a scenario",
    },
    "Run": {
        "time tout": "t",
        "plot scope": "arm3r.plot.overview(run)",
        "data values array simout logsout yout y x": 'run["q"], run["tip"] ... or to_pandas()',
        "save write export to_file": "to_csv(path) or to_npz(path)",
        "to_mat savemat to_excel to_parquet": "to_csv(path), or to_pandas(), which writes other files",
        "to_dict": "dict(run)",
        "read read_csv from_csv open": "Run.load(path)",
        "success status": "outcome",
        "contacts": "events",
        "df dataframe": "to_pandas()",
        "animate": 'arm3r.plot.animate(run, "film.gif")',
    },
    "Scenario": {
        "simulate sim solve start execute": "run()",
        "from_file from_yaml open read": "Scenario.load(path)",
        "examples load_example": 'Scenario.example("moving_wall")',
        "save write dump to_file": "to_yaml(), which returns the text",
        "set set_param set_parameter": 'scenario["wall.contact.stiffness"] = 500',
        "get get_param get_parameter": 'scenario["wall.contact.stiffness"]',
        "parsim sweep run_batch": "batch({...})",
        "check": "validate()",
        "robot model": "arm",
        "plot": "arm3r.plot.overview(scenario.run())",
    },
}
PAIRS = {
    owner: {name: meant for names, meant in table.items() for name in names.split()} for owner, table in _TABLE.items()
}


def no_attribute(owner: str, name: str, known: Iterable[str], *, meant: str = "") -> AttributeError:
    """The error for a name that a class or a module does not have, with what was probably meant.

    known: the public names that there are. meant: what this name is here, where the caller knows it.
    """
    what = f"module {owner!r}" if owner == "arm3r_cpp" else f"{owner!r} object"
    names = [one for one in known if not one.startswith("_")]
    pair = meant or PAIRS[owner].get(name, "")
    near = "" if name.startswith("_") else f"it is {pair}" if pair and pair != _THREE_JOINTS else pair
    if not near and not name.startswith("_"):
        near = did_you_mean(name, names) or f"it has {', '.join(sorted(names))}"
    return AttributeError(f"{what} has no attribute {name!r}{'; ' if near else ''}{near}", name=name)


class Answering(type):
    """The class of classes that answer a wrong name, such as Scenario.from_file."""

    if not TYPE_CHECKING:

        def __getattr__(cls, name: str) -> Any:
            raise no_attribute(cls.__name__, name, dir(cls))
