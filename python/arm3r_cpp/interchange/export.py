"""The file of a scenario's arm for another program."""

from __future__ import annotations

import os
from pathlib import Path

from .._files import check_ending, replacing
from .._messages import shown, warn_user
from ..core.scenario import Scenario
from ..errors import ScenarioWarning, UsageError
from ..robots.arm_bodies import Arm, arm_of
from . import mjcf, wall
from .urdf import urdf_text

ENDINGS = (".urdf", ".xml")


def export(scenario: Scenario, path: str | os.PathLike[str]) -> None:
    """Write the arm of a scenario as URDF (.urdf) or MJCF (.xml), whole or not at all.

    >>> arm3r.export(arm3r.Scenario.example("unequal_arm"), "arm.urdf")

    Joint angles, rates and torques are those of `arm.convention`. MJCF has motors and the state at the start, too, and
    the wall if that acts on the arm. What a format cannot have and is left out is issued as ScenarioWarning.

    Raises:
        UsageError: the name has another ending, or MuJoCo cannot have the arm or the wall; the message names the keys.
        ScenarioError: the scenario is not valid.
        OutputError: the file cannot be written.
    """
    check_ending(path, ENDINGS, hint="URDF or MuJoCo's MJCF")
    arm = arm_of(scenario["arm"])
    is_urdf = Path(path).suffix == ".urdf"
    text, left_out = urdf_text(arm, shown(scenario.name)) if is_urdf else _mjcf(scenario, arm)
    for sentence in left_out:
        warn_user(f"{scenario.file}: {sentence}", ScenarioWarning)
    with replacing(Path(path)) as part:
        part.write_text(text, encoding="utf-8")


def _mjcf(scenario: Scenario, arm: Arm) -> tuple[str, list[str]]:
    keys = scenario["wall"] or {}
    acts = bool(keys) and keys["acts_on_arm"]
    of_arm, of_wall = mjcf.obstacles(arm), wall.obstacles(keys) if acts else []
    if of_arm or of_wall:
        instead = "; leave the wall out by --set wall=null" if of_wall else ""
        instead += "; URDF (.urdf) takes the arm" if of_arm else ""
        raise UsageError(f"{scenario.file}: MuJoCo cannot have: {'. '.join(of_arm + of_wall)}{instead}", code="usage")
    start = {"q": scenario["initial.q"], "qd": scenario["initial.qd"], "start": scenario["time.start"]}
    text, left_out = mjcf.mjcf_text(arm, shown(scenario.name), **start, wall=wall.wall_of(keys) if acts else None)
    if keys and not acts:
        left_out.append("wall.acts_on_arm is false: the wall is left out.")
    if "push" in scenario:
        left_out.append("push: MJCF has no forces that begin and end; it is left out.")
    return text, left_out
