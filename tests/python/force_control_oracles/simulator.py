"""Arm, wall and control law in time: free, contact and separated pieces, each smooth, joined at located events."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from .arm import Arm, Motion
from .wall import Wall

FREE, CONTACT, SEPARATED, STOPPED = "free", "contact", "separated", "stopped"
Control = Callable[[float, Motion, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
"""control(t, motion, force on the tip, memory) -> (torque, rate of the memory)."""


@dataclass
class Run:
    """Dense output, piece by piece: (start, end, mode, t -> state). State: q, qd, memory[, energies]."""

    arm: Arm
    wall: Wall | None
    pieces: list[tuple[float, float, str, Any]] = field(default_factory=list)
    events: list[tuple[str, float]] = field(default_factory=list)
    steps: int = 0

    @property
    def end(self) -> float:
        return self.pieces[-1][1]

    @property
    def mode(self) -> str:
        return self.pieces[-1][2]

    def piece(self, t: float) -> tuple[str, np.ndarray]:
        for _, end, mode, dense in self.pieces:
            if t <= end:
                return mode, dense(t)
        raise ValueError(f"the run ends at {self.end} s, {t} s is later")

    def state(self, t: float) -> np.ndarray:
        return self.piece(t)[1]

    def motion(self, t: float) -> Motion:
        y = self.state(t)
        return self.arm.at(y[:3], y[3:6])

    def force(self, t: float) -> np.ndarray:
        """Of the wall on the tip."""
        mode, y = self.piece(t)
        return self.wall.force(t, self.arm.at(y[:3], y[3:6])) if self.wall and mode == CONTACT else np.zeros(3)

    def pressing(self, times: Sequence[float]) -> np.ndarray:
        """Normal force, N."""
        return np.array([self.wall.normal @ self.force(t) for t in times])

    def tips(self, times: Sequence[float]) -> np.ndarray:
        return np.array([self.motion(t).x for t in times])

    def followed_by(self, later: Run) -> Run:
        events = self.events + later.events
        return Run(self.arm, self.wall, self.pieces + later.pieces, events, self.steps + later.steps)


def simulate(
    arm: Arm,
    control: Control,
    q: Sequence[float],
    stop: float,
    *,
    qd: Sequence[float] = (0.0, 0.0, 0.0),
    memory: Sequence[float] = (),
    wall: Wall | None = None,
    push: Sequence[float] = (0.0, 0.0, 0.0),
    start: float = 0.0,
    mode: str | None = None,
    modes: int = 3,
    until_contact: bool = False,
    until: Callable[[float, Motion, np.ndarray], float] | None = None,
    energies: bool = False,
    rtol: float = 1e-11,
    atol: float = 1e-13,
    method: str = "DOP853",
    max_step: float = np.inf,
) -> Run:
    """push: a constant force on the tip beside the wall's. modes = 2 forgets the surface where its force ends.

    until(t, motion, memory): the run ends where it rises through 0.
    """
    known = len(memory)
    y = np.concatenate([q, qd, memory, np.zeros(5 if energies else 0)])
    run = Run(arm, wall)
    if mode is None:
        mode = CONTACT if wall and wall.depth(start, arm.at(q).x) >= 0 else FREE
    t = start
    while True:
        now = mode

        def slope(t: float, y: np.ndarray, now: str = now) -> np.ndarray:
            s = arm.at(y[:3], y[3:6])
            touch = wall.force(t, s) if wall and now == CONTACT else np.zeros(3)
            force = touch + push
            torque, memory_rate = control(t, s, force, y[6 : 6 + known])
            rates = powers(t, s, torque, touch, wall, now) if energies else ()
            return np.concatenate([s.qd, s.acceleration(torque, force), memory_rate, rates])

        doors = exits(arm, wall, now, modes)
        if until:
            doors.append((crossing(arm, lambda t, s, y: until(t, s, y[6 : 6 + known]), 1), STOPPED))
        events = [door for door, _ in doors]
        part = solve_ivp(
            slope, (t, stop), y, method, dense_output=True, events=events, rtol=rtol, atol=atol, max_step=max_step
        )
        assert part.success, part.message
        t, y = part.t[-1], part.y[:, -1]
        run.pieces.append((part.t[0], t, now, part.sol))
        run.steps += len(part.t) - 1
        if part.status == 0:
            return run
        mode = next(to for (_, to), roots in zip(doors, part.t_events, strict=True) if roots.size)
        run.events.append((mode, t))
        if mode == STOPPED or (until_contact and mode == CONTACT):
            return run


def crossing(arm: Arm, function: Callable[[float, Motion, np.ndarray], float], direction: int) -> Any:
    """An event for scipy that ends the piece."""

    def event(t: float, y: np.ndarray) -> float:
        return function(t, arm.at(y[:3], y[3:6]), y)

    event.terminal, event.direction = True, direction
    return event


def exits(arm: Arm, wall: Wall | None, mode: str, modes: int) -> list[tuple[Any, str]]:
    """Ways out of a mode: an event, and the mode behind it."""
    if wall is None:
        return []

    def depth(direction: int) -> Any:
        return crossing(arm, lambda t, s, _: wall.depth(t, s.x), direction)

    def release(direction: int) -> Any:
        return crossing(arm, lambda t, s, _: wall.release(t, s), direction)

    if mode == FREE:
        return [(depth(1), CONTACT)]
    if mode == SEPARATED:
        return [(release(1), CONTACT), (depth(-1), FREE)]
    if wall.law.release is None:
        return [(depth(-1), FREE)]
    return [(release(-1), SEPARATED if modes == 3 else FREE), (depth(-1), FREE)]


def powers(t: float, s: Motion, torque: np.ndarray, force: np.ndarray, wall: Wall | None, mode: str) -> list[float]:
    """Work of the actuators and of the wall's drive; losses in the joints, in the surface and by sliding."""
    joints = [torque @ s.qd, 0.0, s.arm.friction(s.qd) @ s.qd, 0.0, 0.0]
    if wall is None or mode == FREE:
        return joints
    damped = (wall.normal @ force - wall.law.elastic(wall.depth(t, s.x))) * wall.rate(t, s.xd)
    return [joints[0], force @ wall.velocity(t), joints[2], damped, -force @ wall.sliding(s.xd)]


def residual(run: Run, times: Sequence[float]) -> np.ndarray:
    """The residual of the energy balance of a run, J."""

    def balance(t: float) -> float:
        mode, y = run.piece(t)
        s = run.arm.at(y[:3], y[3:6])
        surface = run.wall.law.stored(run.wall.depth(t, s.x)) if run.wall and mode != FREE else 0.0
        work, drive, *losses = y[-5:]
        return s.energy + surface - work - drive + sum(losses)

    left = np.array([balance(t) for t in times])
    return left - left[0]


def simulate_sampled(
    arm: Arm,
    control: Control,
    q: Sequence[float],
    period: float,
    ticks: int,
    *,
    memory: Sequence[float] = (),
    **keys: Any,
) -> Run:
    """The law at the ticks only, its torque held between them, its memory by Euler's rule."""
    run, z, t = None, np.asarray(memory, dtype=float), 0.0
    wall = keys.get("wall")
    state = np.concatenate([q, keys.pop("qd", np.zeros(3))])
    for tick in range(ticks):
        s = arm.at(state[:3], state[3:6])
        mode = run.mode if run else (CONTACT if wall and wall.depth(0.0, s.x) >= 0 else FREE)
        force = wall.force(t, s) if wall and mode == CONTACT else np.zeros(3)
        torque, rate = control(t, s, force, z)
        z = z + period * rate
        until = (tick + 1) * period
        part = simulate(
            arm,
            lambda *_, held=torque: (held, np.zeros(0)),
            state[:3],
            until,
            qd=state[3:6],
            start=t,
            mode=mode,
            **keys,
        )
        run = run.followed_by(part) if run else part
        t, state = until, part.state(until)
    return run


def simulate_delayed(
    arm: Arm,
    control_of: Callable[[Callable[[float, float], float]], Control],
    q: Sequence[float],
    stop: float,
    delay: float,
    before: float,
    **keys: Any,
) -> Run:
    """control_of(felt): felt(t, f) is the normal force one delay ago, `before` at first; by the method of steps."""
    run, t = None, 0.0

    def felt(t: float, _: float) -> float:
        return float(run.pressing([min(t - delay, run.end)])[0]) if run and t > delay else before

    control = control_of(felt)
    while t < stop:
        later = simulate(arm, control, q, t + delay, start=t, **keys)
        run = run.followed_by(later) if run else later
        t, y = later.end, later.state(later.end)
        q = y[:3]
        keys |= {"qd": y[3:6], "memory": y[6:], "mode": run.mode}
    return run
