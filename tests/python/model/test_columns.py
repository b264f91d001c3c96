"""Every column of the list is written: in some run it is not zero."""

from __future__ import annotations

import arm3r_cpp as arm3r
from conftest import Cli

ARM = (
    "format: 1\narm: {gravity: [0.4, 0.2, -9.8], link3: {length: 0.8}, damping: [0.1, 0.2, 0.3],\n"
    "  torque_limit: [9, 12, 8]}\n"
)
START = "initial: {q: [0.3, 0.4, 0.5], qd: [0.7, 1.0, -0.9]}\ntime: {stop: 0.4}\nchecks: []\n"
WALL = (
    "wall: {point: [1.37, 0.4, -0.9], normal: [-1, 0.2, 0.1], acts_on_arm: true,\n"
    "  motion: {type: sinusoid, amplitude: 0.05, frequency: 2},\n"
    "  contact: {law: kelvin_voigt, stiffness: 900, damping: 4, friction: {coefficient: 0.3}}}\n"
)
FIXED_SPRING = (
    WALL.replace("sinusoid, amplitude: 0.05, frequency: 2", "fixed")
    .replace("kelvin_voigt", "spring")
    .replace(", damping: 4", "")
)
RUNS = [
    f"{ARM}{START}{WALL}controller: {{type: hybrid}}\nreference: {{type: hold, force: {{value: 5}}}}\n"
    "sampling: {rate: 500}\nobserver: {threshold: 0.5}\nestimator: {}\n",
    f"{ARM}{START}{FIXED_SPRING}controller: {{type: hybrid}}\nreference: {{type: hold, force: {{value: 5}}}}\n"
    "sampling: {rate: 500}\nestimator: {}\n",
    f"{ARM}{START}controller: {{type: joint_pd}}\nreference: {{type: point, q: [0.2, 0.3, 0.6]}}\n",
    f"{ARM}{START}{WALL}controller: {{type: energy_tank}}\nreference: {{type: hold}}\n",
    "format: 1\ninitial: {q: [0.1, -0.2, 0.3], qd: [1.5, 0, 0]}\ntime: {stop: 1}\nchecks: []\n"
    "wall: {point: [1.93, 0.2, 0], normal: [-1, 0, 0], size: [0.1, 0.5], acts_on_arm: true,\n"
    "  motion: {type: fixed}, contact: {stiffness: 20}}\ncontroller: {type: gravity_compensation}\n",
]


def test_every_column_is_written(cli: Cli) -> None:
    written = set()
    for text in RUNS:
        run = arm3r.Scenario(text).run()
        written |= {name for name in run.columns if (run[name] != 0).any()}
    listed = {line.split()[0] for line in cli("columns").stdout.splitlines() if line.strip()}
    assert written == listed
