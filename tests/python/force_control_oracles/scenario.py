"""From a setting to its run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from . import laws, wall
from .arm import Arm, Motion
from .settings import Setting, varied
from .simulator import CONTACT, Control, Run, simulate, simulate_delayed, simulate_sampled


def wall_of(setting: Setting) -> wall.Wall | None:
    if "wall" not in setting:
        return None
    keys = setting["wall"]
    contact = dict(keys["contact"])
    law = getattr(wall, contact.pop("law"))(**contact)
    point, normal = np.array(keys["point"]), np.array(keys["normal"])
    if "sinusoid" in keys:
        size, w = keys["sinusoid"]["amplitude"], 2 * np.pi * keys["sinusoid"]["frequency"]
        return wall.Wall(law, point, normal, lambda t: size * np.sin(w * t), lambda t: size * w * np.cos(w * t))
    speed = keys["speed"]
    return wall.Wall(law, point, normal, lambda t: speed * t, lambda t: speed)


def control_of(setting: Setting, **more: Any) -> Control:
    gains = dict(setting["controller"])
    law = getattr(laws, gains.pop("type"))(**gains, **more)
    return laws.observed(law, **setting["observer"]) if "observer" in setting else law


def run_of(setting: Setting, **solver: Any) -> Run:
    """solver: further keywords of `simulate`."""
    arm = Arm(**setting.get("arm", {}))
    keys = {key: setting[key] for key in ("qd", "memory", "push", "start", "modes") if key in setting}
    keys |= {"wall": wall_of(setting)} | solver
    if "ticks" in setting:
        return simulate_sampled(arm, control_of(setting), setting["q"], setting["period"], setting["ticks"], **keys)
    if "delay" in setting:
        before = float(setting["controller"]["f_d"])
        delayed = lambda felt: control_of(setting, felt=felt)  # noqa: E731
        return simulate_delayed(arm, delayed, setting["q"], setting["stop"], setting["delay"], before, **keys)
    if "after contact" in setting:
        first = simulate(arm, control_of(setting), setting["q"], setting["stop"], until_contact=True, **keys)
        return first.followed_by(rest_of(first, setting | setting["after contact"], solver))
    if "after detection" in setting:
        first = simulate(arm, control_of(setting), setting["q"], setting["stop"], until=alarm(setting), **keys)
        return first.followed_by(rest_of(first, setting | setting["after detection"], solver))
    return simulate(arm, control_of(setting), setting["q"], setting["stop"], **keys)


def rest_of(first: Run, then: Setting, solver: dict[str, Any]) -> Run:
    """What follows a switch in contact; where `then` says None, the memory goes on and q_d is where the arm is."""
    y = first.state(first.end)
    memory = y[6:] if then["memory"] is None else then["memory"]
    if then["controller"].get("q_d", True) is None:
        then = varied(then, controller={"q_d": y[:3]})
    keys = {"qd": y[3:6], "memory": memory, "start": first.end, "mode": CONTACT, "wall": first.wall} | solver
    return simulate(first.arm, control_of(then), y[:3], then["stop"], **keys)


def alarm(setting: Setting) -> Callable[[float, Motion, np.ndarray], float]:
    """Rises through 0 where a joint's r reaches the threshold."""
    K_O, threshold = setting["observer"]["K_O"], setting["threshold"]
    return lambda t, s, memory: np.abs(laws.reaction(s, memory, K_O)).max() - threshold
