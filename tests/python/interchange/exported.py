"""What other programs make of an exported file: Pinocchio and Drake of URDF, MuJoCo of MJCF."""

from __future__ import annotations

from typing import NamedTuple

import mujoco
import numpy as np
import pinocchio as pin


class Numbers(NamedTuple):
    """Of an arm in one pose."""

    tip: np.ndarray
    jacobian: np.ndarray
    mass_matrix: np.ndarray
    gravity_torque: np.ndarray


def by_pinocchio(text: str, gravity: list[float], q: np.ndarray) -> Numbers:
    model = pin.buildModelFromXML(text)
    model.gravity.linear = np.array(gravity, float)
    data, tip = model.createData(), model.getFrameId("tip")
    pin.framesForwardKinematics(model, data, q)
    jacobian = pin.computeFrameJacobian(model, data, q, tip, pin.LOCAL_WORLD_ALIGNED)[:3]
    mass_matrix = np.triu(pin.crba(model, data, q)) + np.triu(data.M, 1).T
    weight = pin.computeGeneralizedGravity(model, data, q)
    return Numbers(data.oMf[tip].translation.copy(), jacobian, mass_matrix, weight)


def by_drake(text: str, gravity: list[float], q: np.ndarray) -> Numbers:
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import JacobianWrtVariable

    plant = MultibodyPlant(0.0)
    Parser(plant).AddModelsFromString(text, "urdf")
    base, tip = plant.GetFrameByName("base"), plant.GetFrameByName("tip")
    plant.WeldFrames(plant.world_frame(), base)
    plant.mutable_gravity_field().set_gravity_vector(gravity)
    plant.Finalize()
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, q)
    jacobian = plant.CalcJacobianTranslationalVelocity(
        context, JacobianWrtVariable.kV, tip, np.zeros(3), plant.world_frame(), plant.world_frame()
    )
    weight = -plant.CalcGravityGeneralizedForces(context)
    return Numbers(tip.CalcPoseInWorld(context).translation(), jacobian, plant.CalcMassMatrix(context), weight)


def by_mujoco(text: str, q: np.ndarray) -> Numbers:
    model = mujoco.MjModel.from_xml_string(text)
    data, jacobian, mass_matrix = mujoco.MjData(model), np.zeros((3, 3)), np.zeros((3, 3))
    data.qpos = q
    mujoco.mj_forward(model, data)
    mujoco.mj_jacSite(model, data, jacobian, None, model.site("tip").id)
    for row, unit in zip(mass_matrix, np.eye(3), strict=True):  # it is symmetric
        mujoco.mj_mulM(model, data, row, unit)
    return Numbers(data.site("tip").xpos.copy(), jacobian, mass_matrix, data.qfrc_bias.copy())


def largest_difference(ours: Numbers, theirs: Numbers) -> float:
    """Relative to the largest entry of each quantity."""
    return max(float(np.abs(one - other).max() / np.abs(one).max()) for one, other in zip(ours, theirs, strict=True))
