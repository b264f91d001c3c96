"""The motion of an elbow arm from what its keys mean, twice: in numpy, and by Pinocchio.

`Truth` sums over the bodies, each with the Jacobians of its centre and of its rotation: no recursion from link to link
and no formula in the joint angles. `Pinocchio` has the rotors as three more bodies on joints of their own, which the
gears tie to the joints of the arm. Angles, rates and torques are in the arm's convention, points in base axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from elbow_arms import base_of, inner_angles, signs_and_zeros
from random_scenarios import Keys

GRAVITY = (0.0, 0.0, -9.80665)


def tensor_of(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> np.ndarray:
    """The matrix of the six entries as the keys order them."""
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], float)


@dataclass
class Body:
    """What has mass: a link, a rotor or the payload."""

    frame: int
    """0: base, 1 to 3: links; it carries the body, and the vectors below are in its axes."""
    at: np.ndarray
    """m, of its centre of mass"""
    mass: float
    inertia: np.ndarray
    """kg m^2, about the centre of mass"""
    joint: int = 0
    """1 to 3: that drives a rotor"""
    spin: np.ndarray | None = None
    """of a rotor: how much it turns against the frame for each unit of the joint's angle"""


def bodies_of(arm: Keys) -> list[Body]:
    """Links, payload and rotors."""
    found = []
    for frame in (1, 2, 3):
        link = arm.get(f"link{frame}", {})
        inertia = tensor_of(*link.get("inertia", [0] * 6))
        found.append(Body(frame, np.array(link.get("com", [0, 0, 0]), float), link.get("mass", 0.0), inertia))
    found.append(
        Body(3, np.array(arm["link3"]["tip"], float), arm.get("payload", {}).get("mass", 0.0), np.zeros((3, 3)))
    )
    signs = signs_and_zeros(arm)[0]
    joints = [
        [0, 0, 0],
        [arm.get("shoulder_offset", 0.0), 0, 0],
        [arm["link2"]["length"], 0, arm["link2"].get("offset", 0)],
    ]
    own_axes = [[0, 0, signs[0]], [0, -signs[1], 0], [0, 0, signs[1] * signs[2]]]
    for joint in (1, 2, 3):
        if rotor := arm.get(f"rotor{joint}"):
            axis = np.array(rotor.get("axis", own_axes[joint - 1]), float)
            axis /= np.linalg.norm(axis)
            tensor = rotor["inertia"] * np.outer(axis, axis)
            at = np.array(joints[joint - 1], float)
            found.append(Body(joint - 1, at, rotor.get("mass", 0.0), tensor, joint, rotor["ratio"] * axis))
    return found


class Frames(NamedTuple):
    """Where the base and the links are, at (...) states."""

    rotations: list[np.ndarray]
    """(..., 3, 3) each: the axes as columns"""
    origins: list[np.ndarray]
    """(..., 3) each"""
    axes: list[np.ndarray]
    """(..., 3) each: the positive axes of joints 1, 2, 3"""


def columns(*vectors: np.ndarray) -> np.ndarray:
    return np.stack(vectors, axis=-1)


def along(*parts: tuple[np.ndarray | float, np.ndarray]) -> np.ndarray:
    """A sum of vectors times numbers."""
    return sum(np.asarray(number)[..., None] * vector for number, vector in parts)


def apply(matrix: np.ndarray, vector: np.ndarray) -> np.ndarray:
    return (matrix @ vector[..., None])[..., 0]


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """What numpy.cross returns, at a third of its time."""
    return a[..., [1, 2, 0]] * b[..., [2, 0, 1]] - a[..., [2, 0, 1]] * b[..., [1, 2, 0]]


def transpose(matrix: np.ndarray) -> np.ndarray:
    return matrix.swapaxes(-1, -2)


class Truth:
    """The arm of these keys: functions of (..., 3) arrays as those of `arm3r.Arm`."""

    def __init__(self, arm: Keys) -> None:
        self._arm, self._bodies = arm, bodies_of(arm)
        self._gravity = np.array(arm.get("gravity", GRAVITY), float)
        self._armature = np.broadcast_to(arm.get("armature", 0.0), 3)
        self.tip = np.array(arm["link3"]["tip"], float)

    def frames(self, q: np.ndarray) -> Frames:
        theta = inner_angles(self._arm, q)
        signs = signs_and_zeros(self._arm)[0]
        position, base = base_of(self._arm)
        first, zero = theta[..., 0], np.zeros(theta.shape[:-1])
        e, f, k = (np.broadcast_to(axis, theta.shape) for axis in base.T)
        u, v = along((np.cos(first), e), (np.sin(first), f)), along((-np.sin(first), e), (np.cos(first), f))

        def link(angle: np.ndarray, sign: int) -> np.ndarray:
            x, z = along((np.cos(angle), u), (np.sin(angle), k)), -sign * v
            return columns(x, cross(z, x), z)

        second = link(theta[..., 1], signs[1])
        third = link(theta[..., 1] + theta[..., 2], signs[2])
        upper = self._arm["link2"]
        origin = np.broadcast_to(position, theta.shape)
        shoulder = origin + along((self._arm.get("shoulder_offset", 0.0), u))
        elbow = shoulder + along((upper["length"], second[..., 0]), (upper.get("offset", 0.0), second[..., 2]))
        rotations = [np.broadcast_to(base, (*zero.shape, 3, 3)), columns(u, v, k), second, third]
        return Frames(rotations, [origin, origin, shoulder, elbow], [signs[0] * k, second[..., 2], third[..., 2]])

    def _motion(self, q: np.ndarray, qd: np.ndarray, frame: int, at: np.ndarray) -> tuple[np.ndarray, ...]:
        """Position of a point of a frame, its Jacobian, the frame's angular one, and the rates of both Jacobians."""
        rotations, origins, axes = self.frames(q)
        point = origins[frame] + apply(rotations[frame], np.broadcast_to(at, q.shape))
        J, W = np.zeros((*q.shape, 3)), np.zeros((*q.shape, 3))
        for j in range(frame):
            W[..., j] = axes[j]
            J[..., j] = cross(axes[j], point - origins[j + 1])
        turning = np.zeros_like(q)  # angular velocity of the frame before joint j
        arrived = np.zeros_like(q)  # velocity of the origin on joint j
        J_rate, W_rate, velocity = np.zeros_like(J), np.zeros_like(W), apply(J, qd)
        for j in range(frame):
            turned = cross(turning, axes[j])
            W_rate[..., j] = turned
            J_rate[..., j] = cross(turned, point - origins[j + 1]) + cross(axes[j], velocity - arrived)
            turning = turning + axes[j] * qd[..., j, None]
            if j < 2:
                arrived = arrived + cross(turning, origins[j + 2] - origins[j + 1])
        return point, J, W, J_rate, W_rate

    def _body(self, q: np.ndarray, qd: np.ndarray, body: Body) -> tuple[np.ndarray, ...]:
        """The same of a body, whose rotation is that of its frame and its own spin; last its tensor in base axes."""
        point, J, W, J_rate, W_rate = self._motion(q, qd, body.frame, body.at)
        R = self.frames(q).rotations[body.frame]
        if body.spin is not None:
            axis = apply(R, np.broadcast_to(body.spin, q.shape))
            W_rate[..., body.joint - 1] += cross(apply(W, qd), axis)
            W[..., body.joint - 1] += axis
        return point, J, W, J_rate, W_rate, R @ body.inertia @ transpose(R)

    def frame_rotation(self, q: np.ndarray, frame: int) -> np.ndarray:
        """The axes of a link as columns."""
        return self.frames(np.asarray(q, float)).rotations[frame]

    def tip_position(self, q: np.ndarray) -> np.ndarray:
        return self._motion(q, 0 * q, 3, self.tip)[0]

    def elbow_position(self, q: np.ndarray) -> np.ndarray:
        """The origin of link 3."""
        return self.frames(q).origins[3]

    def centres(self, q: np.ndarray) -> np.ndarray:
        return np.stack([self._body(q, 0 * q, body)[0] for body in self._bodies[:3]], axis=-2)

    def geometric_jacobian(self, q: np.ndarray) -> np.ndarray:
        _, J, W, _, _ = self._motion(q, 0 * q, 3, self.tip)
        return np.concatenate([J, W], axis=-2)

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        return self._motion(q, 0 * q, 3, self.tip)[1]

    def jacobian_dot(self, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        return self._motion(q, qd, 3, self.tip)[3]

    def mass_matrix(self, q: np.ndarray) -> np.ndarray:
        M = np.zeros((*q.shape, 3)) + np.diag(self._armature)
        for body in self._bodies:
            _, J, W, _, _, inertia = self._body(q, 0 * q, body)
            M = M + body.mass * transpose(J) @ J + transpose(W) @ inertia @ W
        return M

    def mass_matrix_dot(self, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        half = np.zeros((*q.shape, 3))
        for body in self._bodies:
            _, J, W, J_rate, W_rate, inertia = self._body(q, qd, body)
            turning = cross(apply(W, qd)[..., None, :], np.eye(3))  # its rows are w x e_i: the transposed matrix of w x
            half = half + body.mass * transpose(J) @ J_rate + transpose(W) @ inertia @ W_rate
            half = half + transpose(W) @ transpose(turning) @ inertia @ W
        return half + transpose(half)

    def velocity_product(self, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        total = np.zeros_like(q)
        for body in self._bodies:
            _, J, W, J_rate, W_rate, inertia = self._body(q, qd, body)
            turning = apply(W, qd)
            total = total + body.mass * apply(transpose(J), apply(J_rate, qd))
            moment = apply(inertia, apply(W_rate, qd)) + cross(turning, apply(inertia, turning))
            total = total + apply(transpose(W), moment)
        return total

    def gravity_torque(self, q: np.ndarray) -> np.ndarray:
        total = np.zeros_like(q)
        for body in self._bodies:
            J = self._body(q, 0 * q, body)[1]
            total = total - body.mass * apply(transpose(J), np.broadcast_to(self._gravity, q.shape))
        return total

    def energy(self, q: np.ndarray, qd: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Kinetic and potential, the latter zero where all mass is at the origin."""
        kinetic = 0.5 * np.sum(self._armature * qd**2, axis=-1)
        potential = np.zeros(q.shape[:-1])
        for body in self._bodies:
            point, J, W, _, _, inertia = self._body(q, qd, body)
            velocity, turning = apply(J, qd), apply(W, qd)
            kinetic = kinetic + 0.5 * body.mass * np.sum(velocity**2, axis=-1)
            kinetic = kinetic + 0.5 * np.sum(turning * apply(inertia, turning), axis=-1)
            potential = potential - body.mass * point @ self._gravity
        return kinetic, potential

    def friction_torque(self, qd: np.ndarray) -> np.ndarray:
        """Of damping and friction."""
        steep = np.tanh(qd / np.array(self._arm.get("friction_velocity", 1.0)))
        return np.array(self._arm.get("damping", 0.0)) * qd + np.array(self._arm.get("friction", 0.0)) * steep

    def inverse_dynamics(self, q: np.ndarray, qd: np.ndarray, qdd: np.ndarray, f_on_tip: np.ndarray) -> np.ndarray:
        inner = apply(self.mass_matrix(q), qdd) + self.velocity_product(q, qd) + self.gravity_torque(q)
        return inner + self.friction_torque(qd) - apply(transpose(self.jacobian(q)), f_on_tip)

    def forward_dynamics(self, q: np.ndarray, qd: np.ndarray, tau: np.ndarray, f_on_tip: np.ndarray) -> np.ndarray:
        left = tau - self.inverse_dynamics(q, qd, 0 * q, f_on_tip)
        return np.linalg.solve(self.mass_matrix(q), left[..., None])[..., 0]


class Pinocchio:
    """The arm of these keys for one state at a time.

    The joints are in depth-first order, which crba needs: otherwise its matrix is silently wrong.
    """

    def __init__(self, arm: Keys) -> None:
        position, base = base_of(arm)
        *links, payload = [body for body in bodies_of(arm) if not body.joint]
        rotors = {body.joint: body for body in bodies_of(arm) if body.joint}
        places = self._places(arm)
        model, ratios, parent = pin.Model(), [], 0
        for joint, place, body in zip((1, 2, 3), places, links, strict=True):
            if rotor := rotors.get(joint):
                ratio = np.linalg.norm(rotor.spin)
                seat = pin.SE3(base, position) if joint == 1 else pin.SE3(np.eye(3), rotor.at)
                kind = pin.JointModelRevoluteUnaligned(rotor.spin / ratio)
                added = model.addJoint(parent, kind, seat, f"rotor{joint}")
                model.appendBodyToJoint(added, pin.Inertia(rotor.mass, np.zeros(3), rotor.inertia), pin.SE3.Identity())
                ratios.append((joint, ratio))
            turns = signs_and_zeros(arm)[0][0] if joint == 1 else 1
            kind = pin.JointModelRevoluteUnaligned(np.array([0.0, 0.0, turns]))
            parent = model.addJoint(parent, kind, place, f"joint{joint}")
            model.appendBodyToJoint(parent, pin.Inertia(body.mass, body.at, body.inertia), pin.SE3.Identity())
            ratios.append((joint, 1.0))
        tip = pin.SE3(np.eye(3), payload.at)
        model.appendBodyToJoint(parent, pin.Inertia(payload.mass, np.zeros(3), np.zeros((3, 3))), tip)
        model.gravity.linear = np.array(arm.get("gravity", GRAVITY), float)
        self._tip = model.addFrame(pin.Frame("tip", parent, tip, pin.FrameType.OP_FRAME))
        self._armature = np.diag(np.broadcast_to(arm.get("armature", 0.0), 3))
        self.model, self.data = model, model.createData()
        self._gears = np.zeros((model.nv, 3))
        for row, (joint, ratio) in enumerate(ratios):
            self._gears[row, joint - 1] = ratio

    @staticmethod
    def _places(arm: Keys) -> list[pin.SE3]:
        """Of the joints where they read zero, each in the frame before: z along the axis, of joint 1 along axis 1."""
        (_, s2, s3), zeros = signs_and_zeros(arm)
        position, base = base_of(arm)
        upper = arm["link2"]
        onto_second = np.array([[1.0, 0, 0], [0, 0, -s2], [0, s2, 0]])  # columns: x, y and z
        onto_third = np.diag([1.0, s2 * s3, s2 * s3])

        def turn(angle: float) -> np.ndarray:
            return pin.utils.rotate("z", angle)

        return [
            pin.SE3(base @ turn(zeros[0]), position),
            pin.SE3(onto_second @ turn(s2 * zeros[1]), np.array([arm.get("shoulder_offset", 0.0), 0, 0])),
            pin.SE3(onto_third @ turn(s3 * zeros[2]), np.array([upper["length"], 0, upper.get("offset", 0.0)])),
        ]

    def mass_matrix(self, q: np.ndarray) -> np.ndarray:
        M = np.triu(pin.crba(self.model, self.data, self._gears @ q))
        return self._gears.T @ (M + np.triu(M, 1).T) @ self._gears + self._armature

    def gravity_torque(self, q: np.ndarray) -> np.ndarray:
        return self._gears.T @ pin.computeGeneralizedGravity(self.model, self.data, self._gears @ q)

    def velocity_product(self, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        weightless = pin.Model(self.model)
        weightless.gravity.linear = np.zeros(3)
        return self._gears.T @ pin.nonLinearEffects(weightless, self.data, self._gears @ q, self._gears @ qd)

    def energy(self, q: np.ndarray, qd: np.ndarray) -> tuple[float, float]:
        Q, V = self._gears @ q, self._gears @ qd
        kinetic = pin.computeKineticEnergy(self.model, self.data, Q, V) + qd @ self._armature @ qd / 2
        return kinetic, pin.computePotentialEnergy(self.model, self.data, Q)

    def tip(self, q: np.ndarray, qd: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Position, geometric Jacobian (linear rows first), and the rate of the Jacobian."""
        Q, V, axes = self._gears @ q, self._gears @ qd, pin.LOCAL_WORLD_ALIGNED
        J = pin.computeFrameJacobian(self.model, self.data, Q, self._tip, axes) @ self._gears
        pin.computeJointJacobiansTimeVariation(self.model, self.data, Q, V)
        rate = pin.getFrameJacobianTimeVariation(self.model, self.data, self._tip, axes) @ self._gears
        pin.updateFramePlacement(self.model, self.data, self._tip)
        return self.data.oMf[self._tip].translation.copy(), J, rate[:3]

    def forward_dynamics(self, q: np.ndarray, qd: np.ndarray, tau: np.ndarray) -> np.ndarray:
        """Without friction: of the projected equations."""
        bias = self._gears.T @ pin.nonLinearEffects(self.model, self.data, self._gears @ q, self._gears @ qd)
        return np.linalg.solve(self.mass_matrix(q), tau - bias)
