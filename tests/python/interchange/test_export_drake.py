"""`arm3r export X.urdf`: Drake makes the same arm of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from arm3r_cpp.interchange.urdf import urdf_text
from arm3r_cpp.robots.arm_bodies import arm_of
from exported import by_drake, largest_difference
from test_export import LIMIT, numbers_of, random_scenario, text_of
from test_export_elbow import as_urdf_has_it, random_elbow
from test_export_elbow import numbers_of as numbers_of_elbow

pytestmark = [pytest.mark.gate, pytest.mark.needs("drake")]

ARMS = 100


def test_drake_computes_the_same_planar_arms(tmp_path: Path) -> None:
    for seed in range(ARMS):
        rng = np.random.default_rng(seed)
        scenario, q = random_scenario(rng), rng.uniform(-4, 4, 3)
        theirs = by_drake(text_of(scenario, tmp_path / "arm.urdf"), scenario["arm.gravity"], q)
        rotors = np.diag(scenario["arm.armature"])
        theirs = theirs._replace(mass_matrix=theirs.mass_matrix + rotors)
        assert largest_difference(numbers_of(scenario, q), theirs) <= LIMIT


def test_drake_computes_the_same_elbow_arms() -> None:
    for seed in range(ARMS):
        rng = np.random.default_rng(seed)
        keys, q = random_elbow(rng), rng.uniform(-4, 4, 3)
        theirs = by_drake(urdf_text(arm_of(keys), "elbow")[0], keys["gravity"], q)
        assert largest_difference(numbers_of_elbow(as_urdf_has_it(keys), q), theirs) <= LIMIT
