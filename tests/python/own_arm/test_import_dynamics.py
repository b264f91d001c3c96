"""The keys that are made of a URDF, evaluated by what they mean, against Pinocchio's reduced model of the file."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
from arm3r_cpp import ScenarioWarning
from arm3r_cpp.robots.explicit import explicit_arm
from elbow_keys import ElbowKeys
from numpy.typing import NDArray
from random_urdfs import RandomUrdf

Floats = NDArray[np.float64]
GRAVITY = np.array([0.3, -0.7, -9.6])


class Reduced:
    """Pinocchio's model of a file whose other joints are locked."""

    def __init__(self, text: str, joints: list[str], lock: dict[str, float], tip: str) -> None:
        whole = pin.buildModelFromXML(text)
        held = [name for name in whole.names[1:] if name not in joints]
        place = pin.neutral(whole)
        for name in held:
            self.set(whole, place, name, lock.get(name, 0.0))
        self.model = pin.buildReducedModel(whole, [whole.getJointId(name) for name in held], place)
        self.model.gravity.linear = GRAVITY
        self.data, self.tip, self.joints = self.model.createData(), self.model.getFrameId(tip), joints

    @staticmethod
    def set(model: Any, place: Floats, name: str, position: float) -> None:
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 2:  # a continuous joint
            place[joint.idx_q : joint.idx_q + 2] = np.cos(position), np.sin(position)
        else:
            place[joint.idx_q] = position

    def place(self, q: Floats) -> Floats:
        found = pin.neutral(self.model)
        for name, position in zip(self.joints, q, strict=True):
            self.set(self.model, found, name, position)
        return found

    def values(self, q: Floats, qd: Floats, qdd: Floats) -> dict[str, Floats]:
        place = self.place(q)
        mass = pin.crba(self.model, self.data, place).copy()
        torque = pin.rnea(self.model, self.data, place, qd, qdd).copy()
        jacobian = pin.computeFrameJacobian(self.model, self.data, place, self.tip, pin.LOCAL_WORLD_ALIGNED)[:3].copy()
        pin.framesForwardKinematics(self.model, self.data, place)
        return {
            "tip": self.data.oMf[self.tip].translation.copy(),
            "jacobian": jacobian,
            "mass": np.triu(mass) + np.triu(mass, 1).T,
            "torque": torque,
            "gravity": pin.computeGeneralizedGravity(self.model, self.data, place).copy(),
        }


def worst_difference(text: str, keys: str, joints: list[str], lock: dict[str, float], tip: str) -> float:
    """Of tip, Jacobian, mass matrix, torques and gravity, relative to the largest entry of each, over random states."""
    ours, theirs, random = ElbowKeys(keys), Reduced(text, joints, lock, tip), np.random.default_rng(5)
    worst = 0.0
    for _ in range(5):
        q, qd, qdd = random.uniform(-3, 3, (3, 3))
        found = {
            "tip": ours.tip_position(q),
            "jacobian": ours.jacobian(q),
            "mass": ours.mass_matrix(q),
            "torque": ours.inverse_dynamics(q, qd, qdd, GRAVITY),
            "gravity": ours.inverse_dynamics(q, np.zeros(3), np.zeros(3), GRAVITY),
        }
        for name, due in theirs.values(q, qd, qdd).items():
            worst = max(worst, np.abs(found[name] - due).max() / np.abs(due).max())
    return worst


@pytest.mark.parametrize("seed", range(40))
def test_the_keys_describe_the_arm_of_the_file(tmp_path: Path, seed: int) -> None:
    """Frames of any direction, fixed and locked joints between, branches, signs, zeros and lateral offsets."""
    urdf = RandomUrdf(np.random.default_rng(seed), is_upright=seed % 2 == 0)
    (tmp_path / "arm.urdf").write_text(urdf.text)
    joints = ["joint1", "joint2", "joint3"]
    request = {"urdf": "arm.urdf", "folder": tmp_path, "joints": joints, "lock": urdf.lock, "tip": "tip"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ScenarioWarning)
        keys = explicit_arm(request)
    assert worst_difference(urdf.text, keys, joints, urdf.lock, "tip") < 1e-13
    found = ElbowKeys(keys)
    if urdf.is_upright:
        assert found.keys["base"]["rotation"] == [0, 0, 0]
    assert found.keys["shoulder_offset"] >= 0 and found.keys["link3"]["tip"][1] == 0
