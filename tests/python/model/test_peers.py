"""The arm against two engines that share nothing with it, built here from the same numbers: Pinocchio and MuJoCo."""

from __future__ import annotations

from dataclasses import dataclass

import arm3r_cpp as arm3r
import mujoco
import numpy as np
import pinocchio as pin
import pytest

ARMS, STATES, LIMIT = 25, 20, 1e-9


@dataclass
class Link:
    length: float
    mass: float
    com: float
    inertia: np.ndarray
    """x along the link, y in the arm's vertical plane, z along the joint."""

    @property
    def inertia_in_base_axes(self) -> np.ndarray:
        """About the centre of mass at q = 0, where the link lies along x and its joint along y."""
        x, y, z = self.inertia
        return np.array([x, z, y])


@dataclass
class Numbers:
    """All that an arm can have, none of it equal to anything else."""

    convention: str
    base_height: float
    gravity: np.ndarray
    link1_mass: float
    link1_com: float
    link1_inertia: float
    links: tuple[Link, Link]
    payload: float
    armature: np.ndarray
    damping: np.ndarray

    @property
    def axis(self) -> np.ndarray:
        """Of joints 2 and 3 at q = 0."""
        return np.array([0.0, {"simscape": 1.0, "slide": -1.0}[self.convention], 0.0])


def random_link(rng: np.random.Generator) -> Link:
    length = rng.uniform(0.3, 1.2)
    a, b, c = rng.uniform(0.005, 0.05, 3)
    return Link(length, rng.uniform(0.3, 3), length * rng.uniform(0.1, 0.9), np.array([b + c, a + c, a + b]))


def random_numbers(rng: np.random.Generator, convention: str) -> Numbers:
    return Numbers(
        convention=convention,
        base_height=rng.uniform(-1, 1),
        gravity=rng.uniform(-10, 10, 3),
        link1_mass=rng.uniform(0.3, 3),
        link1_com=rng.uniform(-0.5, 0.5),
        link1_inertia=rng.uniform(0.1, 0.5),
        links=(random_link(rng), random_link(rng)),
        payload=rng.uniform(0.1, 2),
        armature=rng.uniform(0, 0.1, 3),
        damping=rng.uniform(0, 0.5, 3),
    )


def our_arm(n: Numbers) -> arm3r.Arm:
    scenario = arm3r.Scenario()
    scenario["arm.convention"] = n.convention
    scenario["arm.base_height"] = n.base_height
    scenario["arm.gravity"] = n.gravity.tolist()
    scenario["arm.link1"] = {"mass": n.link1_mass, "com": n.link1_com, "inertia_axial": n.link1_inertia}
    for name, link in zip(("link2", "link3"), n.links, strict=True):
        scenario[f"arm.{name}"] = {
            "length": link.length,
            "mass": link.mass,
            "com": link.com,
            "inertia": link.inertia.tolist(),
        }
    scenario["arm.payload.mass"] = n.payload
    scenario["arm.armature"] = n.armature.tolist()
    scenario["arm.damping"] = n.damping.tolist()
    return scenario.arm


def states(rng: np.random.Generator) -> dict[str, np.ndarray]:
    return {
        "q": rng.uniform(-4, 4, (STATES, 3)),
        "qd": rng.uniform(-5, 5, (STATES, 3)),
        "tau": rng.uniform(-20, 20, (STATES, 3)),
        "f": rng.uniform(-30, 30, (STATES, 3)),
    }


@pytest.fixture(params=[(convention, seed) for convention in ("simscape", "slide") for seed in range(ARMS)], ids=str)
def case(request: pytest.FixtureRequest) -> tuple[Numbers, arm3r.Arm, dict[str, np.ndarray]]:
    convention, seed = request.param
    rng = np.random.default_rng(seed)
    numbers = random_numbers(rng, convention)
    return numbers, our_arm(numbers), states(rng)


def agree(ours: np.ndarray | float, theirs: np.ndarray | float, what: str) -> None:
    error = np.abs(np.asarray(ours) - theirs).max() / (1 + np.abs(theirs).max())
    assert error <= LIMIT, f"{what}: {error:.1e}"


# ---- Pinocchio ------------------------------------------------------------------------------------------------------


def pinocchio_model(n: Numbers) -> tuple[pin.Model, int]:
    def at(x: float, z: float) -> pin.SE3:
        return pin.SE3(np.eye(3), np.array([x, 0.0, z]))

    model = pin.Model()
    model.gravity.linear = n.gravity
    first = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), "1")
    second = model.addJoint(first, pin.JointModelRevoluteUnaligned(n.axis), at(0, n.base_height), "2")
    third = model.addJoint(second, pin.JointModelRevoluteUnaligned(n.axis), at(n.links[0].length, 0), "3")
    turret = pin.Inertia(n.link1_mass, np.array([0, 0, n.link1_com]), np.eye(3) * n.link1_inertia)
    model.appendBodyToJoint(first, turret, pin.SE3.Identity())
    for joint, link in zip((second, third), n.links, strict=True):
        body = pin.Inertia(link.mass, np.array([link.com, 0, 0]), np.diag(link.inertia_in_base_axes))
        model.appendBodyToJoint(joint, body, pin.SE3.Identity())
    tip = at(n.links[1].length, 0)
    model.appendBodyToJoint(third, pin.Inertia(n.payload, np.zeros(3), np.zeros((3, 3))), tip)
    model.armature = n.armature
    return model, model.addFrame(pin.Frame("tip", third, tip, pin.FrameType.OP_FRAME))


def test_pinocchio_says_the_same(case: tuple[Numbers, arm3r.Arm, dict[str, np.ndarray]]) -> None:
    n, arm, state = case
    model, tip = pinocchio_model(n)
    data, axes = model.createData(), pin.LOCAL_WORLD_ALIGNED
    for q, qd, tau, f in zip(*state.values(), strict=True):
        pin.forwardKinematics(model, data, q, qd)
        pin.updateFramePlacements(model, data)
        J6 = pin.computeFrameJacobian(model, data, q, tip, axes)
        J = J6[:3]
        agree(arm.tip_position(q), data.oMf[tip].translation, "tip")
        agree(arm.geometric_jacobian(q), J6, "geometric Jacobian")
        agree(arm.tip_sensor(q, qd)[1], pin.getFrameVelocity(model, data, tip, axes).linear, "tip velocity")
        pin.computeJointJacobiansTimeVariation(model, data, q, qd)
        agree(arm.jacobian_dot(q, qd), pin.getFrameJacobianTimeVariation(model, data, tip, axes)[:3], "J-dot")

        M = np.triu(pin.crba(model, data, q)) + np.triu(data.M, 1).T
        gravity = pin.computeGeneralizedGravity(model, data, q)
        agree(arm.mass_matrix(q), M, "M")
        agree(arm.gravity_torque(q), gravity, "tau_g")
        agree(arm.velocity_product(q, qd), pin.nonLinearEffects(model, data, q, qd) - gravity, "C qd")
        inverse = pin.rnea(model, data, q, qd, tau) + n.damping * qd - J.T @ f
        agree(arm.inverse_dynamics(q, qd, tau, f_on_tip=f), inverse, "inverse dynamics")
        forward = pin.aba(model, data, q, qd, tau - n.damping * qd + J.T @ f)
        agree(arm.forward_dynamics(q, qd, tau, f_on_tip=f), forward, "forward dynamics")
        agree(arm.recursion_forward_dynamics(q, qd, tau, f_on_tip=f), forward, "forward dynamics by recursion")
        potential = pin.computePotentialEnergy(model, data, q)
        agree(arm.energy(q, qd)[0], qd @ M @ qd / 2, "kinetic energy")
        agree(arm.energy(q, qd)[1], potential, "potential energy")
        W = J @ np.linalg.solve(M, J.T)
        agree(arm.effective_mass(q, f), f @ f / (f @ W @ f), "effective mass")
        agree(arm.manipulability(q), abs(np.linalg.det(J)), "manipulability")


# ---- MuJoCo ---------------------------------------------------------------------------------------------------------


def mujoco_model(n: Numbers) -> mujoco.MjModel:
    def numbers(*values: float) -> str:
        return " ".join(repr(float(value)) for value in values)

    def joint(i: int, axis: np.ndarray) -> str:
        return (
            f'<joint name="{i + 1}" type="hinge" axis="{numbers(*axis)}" armature="{numbers(n.armature[i])}" '
            f'damping="{numbers(n.damping[i])}"/>'
        )

    def inertial(link: Link) -> str:
        return (
            f'<inertial pos="{numbers(link.com, 0, 0)}" mass="{numbers(link.mass)}" '
            f'diaginertia="{numbers(*link.inertia_in_base_axes)}"/>'
        )

    second, third = n.links
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <compiler angle="radian"/>
          <option gravity="{numbers(*n.gravity)}"><flag energy="enable" contact="disable"/></option>
          <worldbody>
            <body>
              {joint(0, np.array([0, 0, 1]))}
              <inertial pos="{numbers(0, 0, n.link1_com)}" mass="{numbers(n.link1_mass)}"
                        diaginertia="{numbers(*[n.link1_inertia] * 3)}"/>
              <body pos="{numbers(0, 0, n.base_height)}">
                {joint(1, n.axis)} {inertial(second)}
                <body name="link3" pos="{numbers(second.length, 0, 0)}">
                  {joint(2, n.axis)} {inertial(third)}
                  <body name="tip" pos="{numbers(third.length, 0, 0)}">
                    <inertial pos="0 0 0" mass="{numbers(n.payload)}" diaginertia="1e-13 1e-13 1e-13"/>
                  </body>
                </body>
              </body>
            </body>
          </worldbody>
        </mujoco>""")


def test_mujoco_says_the_same(case: tuple[Numbers, arm3r.Arm, dict[str, np.ndarray]]) -> None:
    n, arm, state = case
    model = mujoco_model(n)
    data, tip = mujoco.MjData(model), model.body("tip").id
    J, M = np.empty((3, 3)), np.empty((3, 3))
    for q, qd, tau, f in zip(*state.values(), strict=True):
        data.qpos, data.qvel, data.qfrc_applied = q, qd, tau
        data.xfrc_applied[tip, :3] = f
        mujoco.mj_forward(model, data)
        mujoco.mj_jacBody(model, data, J, None, tip)
        for row, unit in zip(M, np.eye(3), strict=True):  # M is symmetric
            mujoco.mj_mulM(model, data, row, unit)
        agree(arm.tip_position(q), data.xpos[tip], "tip")
        agree(arm.jacobian(q), J, "J")
        agree(arm.mass_matrix(q), M, "M")
        agree(arm.velocity_product(q, qd) + arm.gravity_torque(q), data.qfrc_bias, "C qd + tau_g")
        agree(arm.forward_dynamics(q, qd, tau, f_on_tip=f), data.qacc, "forward dynamics")
        agree(np.array(arm.energy(q, qd)), data.energy[::-1], "energies")
