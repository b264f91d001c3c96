"""Runs that press on a wall, as the library writes them, from a model of their own: the third-order force loop along
the normal, a second-order position loop across it, and the arm's functions for joints and torques."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
from arm3r_cpp._hash import fnv1a64

NORMAL = -np.array([np.cos(0.4), np.sin(0.4), 0.0])
E1 = np.array([NORMAL[1], -NORMAL[0], 0.0])
E2 = np.array([0.0, 0.0, 1.0])
CENTRE = -1.72 * NORMAL + [0.0, 0.0, -0.1]
START = -1.70 * NORMAL + 0.05 * E1 + 0.03 * E2
SPEED, STIFFNESS, WANTED = 0.05, 5000.0, 20.0
SCENARIO = f"""
format: 1
name: hybrid
arm: {{torque_limit: [20, 30, 25]}}
initial: {{q: [0.4, -0.55, 1.1]}}
wall: {{point: {CENTRE.tolist()}, normal: {NORMAL.tolist()}, size: [1.0, 0.6], motion: {{type: constant,
  velocity: {SPEED}}}, contact: {{stiffness: {STIFFNESS}}}, acts_on_arm: true}}
controller: {{type: hybrid}}
reference: {{type: circle, radius: 0.1, force: {{value: {WANTED}}}}}
observer: {{threshold: [8, 6, 3]}}
time: {{stop: 4, log_every: 0.002}}
"""
UNITS = {"t": "s", "q": "rad", "tip": "m", "wall": "m", "tau": "N m", "f": "N", "residual": "N m"}
FINE = 2e-4  # s: the step of the model


def hybrid(
    *, name: str = "hybrid", kp: float = 0.5, ki: float = 5.0, b: float = 70.0, every: int = 10, stop: float = 4.0,
    circle: float = 0.1, metrics: Mapping[str, Any] | None = None,
) -> arm3r.Run:  # fmt: skip
    """Hybrid control that takes over at the first contact; a row at each `every`-th step of FINE."""
    t = FINE * np.arange(round(stop / FINE) + 1)
    depth = force_loop(t, kp, ki, b)
    wanted = circle * turn(t)
    tip, reference = place(depth, t, track(t, wanted)), place(np.zeros_like(t), t, wanted)
    force = STIFFNESS * np.maximum(depth, 0.0)
    facts = {
        "peak_force": force.max(), "overshoot": force.max() - WANTED, "contacts": 1,
        "settling_time": settling(t, force), "contact_time": t[force > 0][-1] - t[force > 0][0],
        "force_error_rms": rms(force[force > 0] - WANTED), "force_error_peak": WANTED,
        "tip_path_error_rms": rms(np.linalg.norm(tip - reference, axis=1)[force > 0]),
        "tip_path_error_max": float(np.linalg.norm(tip - reference, axis=1)[force > 0].max()),
        "saturation_share": 0.0,
    }  # fmt: skip
    columns = rows_of(t, tip, reference, force, every)
    make = t[np.flatnonzero(force > 0)[0]]
    scenario = arm3r.Scenario(SCENARIO)
    scenario["name"] = name
    return run_of(columns, scenario, [event("make", make)], {**facts, **(metrics or {})})


def bounce() -> arm3r.Run:
    """A contact of 7 ms and 11.8 N, in rows of 10 ms: one of them sees 5 N."""
    t = 0.01 * np.arange(101)
    make, duration, peak = 0.5 - 0.007 * np.arcsin(5 / 11.8) / np.pi, 0.007, 11.8
    into = (t - make) / duration
    force = np.where((into > 0) & (into < 1), peak * np.sin(np.pi * np.clip(into, 0, 1)), 0.0)
    tip = place(force / STIFFNESS, t, np.zeros((len(t), 2)))
    columns = rows_of(t, tip, tip, force, 1)
    columns["contact"][:] = force > 0
    events = [event("make", make), event("break", make + duration)]
    return run_of(columns, arm3r.Scenario(SCENARIO), events, {"peak_force": peak, "settling_time": None})


def stored(run: arm3r.Run, path: Path) -> Path:
    """The run as PATH.csv with PATH.json beside it."""
    data = np.stack([run[name] for name in run.columns], axis=1)
    lines = [",".join(run.columns), *(",".join(map(repr, row)) for row in data.tolist())]
    path.write_text("\n".join(lines) + "\n")
    path.with_suffix(".json").write_text(json.dumps(run.summary))
    return path


def run_of(columns: dict[str, Any], scenario: arm3r.Scenario, events: list[Any], metrics: dict[str, Any]) -> arm3r.Run:
    columns = {name: np.ascontiguousarray(column, float) for name, column in columns.items()}
    units = {name: unit_of(name) for name in columns}
    summary = {
        "name": scenario.name, "outcome": "ok", "message": "", "t_end": columns["t"][-1],
        "events": events, "checks": [],
        "peak_force": metrics["peak_force"], "metrics": metrics, "warnings": [], "rows": len(columns["t"]),
        "hash": fnv1a64(columns.values()), "columns": [{"name": name, "unit": unit} for name, unit in units.items()],
        "scenario": scenario.to_yaml(),
    }  # fmt: skip
    return arm3r.Run(columns, units, summary, None)


def without(run: arm3r.Run, *names: str, **summary: Any) -> arm3r.Run:
    """The run without columns of these names, or with a letter or digit behind them."""
    gone = [
        name
        for name in run.columns
        if any(name in (n, *(n + end for end in (*"123", "_x", "_y", "_z"))) for n in names)
    ]
    kept = {name: run[name] for name in run.columns if name not in gone}
    return changed(arm3r.Run(kept, run.units, run.summary, None), {}, **summary)


def changed(run: arm3r.Run, columns: dict[str, Any], **summary: Any) -> arm3r.Run:
    """The run with other or more columns, and with other words in its summary."""
    held = {**{name: run[name] for name in run.columns}, **{n: np.array(c, float) for n, c in columns.items()}}
    units = {name: run.units.get(name) or unit_of(name) for name in held}
    listed = [{"name": name, "unit": unit} for name, unit in units.items()]
    return arm3r.Run(held, units, {**run.summary, "hash": fnv1a64(held.values()), "columns": listed, **summary}, None)


# ---- the model ------------------------------------------------------------------------------------------------------


def force_loop(t: Any, kp: float, ki: float, b: float) -> Any:
    """Depth: free until the wall is there, then m u'' = kp e + ki int e - b s', e = wanted - k u."""

    def derivative(u: float, s: float, z: float) -> tuple[float, float, float]:
        error = WANTED - STIFFNESS * max(u, 0.0)
        return (s + SPEED, kp * error + ki * z - b * s, error) if u > 0 else (SPEED, 0.0, 0.0)

    def moved(y: tuple[float, ...], h: float, k: tuple[float, ...]) -> tuple[float, float, float]:
        return y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2]

    y = (-0.02, 0.0, 0.0)
    depths = [y[0]]
    for _ in t[1:]:
        k1 = derivative(*y)
        k2 = derivative(*moved(y, FINE / 2, k1))
        k3 = derivative(*moved(y, FINE / 2, k2))
        k4 = derivative(*moved(y, FINE, k3))
        y = moved(y, FINE / 6, tuple(a + 2 * b + 2 * c + d for a, b, c, d in zip(k1, k2, k3, k4, strict=True)))
        depths.append(y[0])
    return np.array(depths)


def turn(t: Any) -> Any:
    """A circle of radius 1 on the face from 1 s to 4 s, about (-1, 0), at rest at both ends."""
    x = np.clip((t - 1) / 3, 0, 1)
    angle = 2 * np.pi * x**3 * (10 - 15 * x + 6 * x**2)
    return np.stack([np.cos(angle) - 1, np.sin(angle)], axis=1)


def track(t: Any, wanted: Any) -> Any:
    """Across the face: a double integrator with K 400, D 40 that knows no feedforward."""
    paths = []
    for targets in wanted.T.tolist():
        position, velocity, path = targets[0], 0.0, []
        for target in targets:
            path.append(position)
            velocity += FINE * (400 * (target - position) - 40 * velocity)
            position += FINE * velocity
        paths.append(path)
    return np.array(paths).T


def place(depth: Any, t: Any, across: Any) -> Any:
    """The tip in base axes, from its depth and its place on the face relative to the start."""
    moved = CENTRE + SPEED * t[:, None] * NORMAL
    start = (START - CENTRE) @ np.stack([E1, E2], axis=1)
    return moved - depth[:, None] * NORMAL + (across + start) @ np.stack([E1, E2])


def rows_of(t: Any, tip: Any, reference: Any, force: Any, every: int) -> dict[str, Any]:
    arm = arm3r.Scenario(SCENARIO).arm
    q = arm.inverse_kinematics(tip)
    qd = np.gradient(q, t, axis=0)
    on_tip = force[:, None] * NORMAL
    tau = arm.inverse_dynamics(q, qd, np.gradient(qd, t, axis=0), on_tip)
    transposed = arm.jacobian(q).transpose(0, 2, 1)
    external = (transposed @ on_tip[..., None])[..., 0]
    residual = lagged(external, 50.0, t)
    noise = np.random.default_rng(7).normal(0, 0.15, len(t))
    columns = {
        "t": t, **triple("q", "123", q), **triple("qd", "123", qd), **triple("tau", "123", tau),
        **triple("tip_", "xyz", tip), **triple("wall_", "xyz", CENTRE + SPEED * t[:, None] * NORMAL),
        "depth": (CENTRE - tip) @ NORMAL + SPEED * t, "contact": force > 0, **triple("f_on_tip_", "xyz", on_tip),
        **triple("f_on_wall_", "xyz", -on_tip), "force": force, "force_ref": np.full(len(t), WANTED),
        "force_measured": lagged(force[:, None], 300.0, t)[:, 0] + noise, **triple("tip_ref_", "xyz", reference),
        "force_phase": force > 0, **triple("residual", "123", residual),
        **triple("f_estimate_", "xyz", np.linalg.solve(transposed, residual[..., None])[..., 0]),
        "saturated": np.abs(tau[:, 1]) > 30,
    }  # fmt: skip
    return {name: np.asarray(column, float)[::every].copy() for name, column in columns.items()}


def lagged(signal: Any, rate: float, t: Any) -> Any:
    """Through a first-order filter."""
    share, filtered = 1 - float(np.exp(-rate * (t[1] - t[0]))), []
    for values in signal.T.tolist():
        state, out = 0.0, []
        for value in values:
            state += share * (value - state)
            out.append(state)
        filtered.append(out)
    return np.array(filtered).T


def triple(name: str, ends: str, values: Any) -> dict[str, Any]:
    return {name + end: values[:, i] for i, end in enumerate(ends)}


def settling(t: Any, force: Any) -> float | None:
    """From the first contact on, into 5 %."""
    made = t[np.flatnonzero(force > 0)[0]]
    out = np.flatnonzero((force > 0) & (np.abs(force - WANTED) > 0.05 * WANTED))
    return float(t[out[-1]] - made) if out[-1] < len(t) - 1 else None


def rms(values: Any) -> float:
    return float(np.sqrt(np.mean(values**2)))


def event(kind: str, t: float) -> dict[str, Any]:
    return {"type": kind, "t": float(t), "q": [0.0] * 3, "qd": [0.0] * 3, "tip": START.tolist()}


def unit_of(name: str) -> str:
    if name in ("contact", "force_phase", "saturated"):
        return "1"
    return UNITS.get(name.split("_")[0].rstrip("123"), {"qd": "rad/s", "depth": "m"}.get(name.rstrip("123"), "N"))
