"""Logs as input: numbers with and without noise, of one arm and of several."""

from __future__ import annotations

import itertools
import os
import random
import re
from collections import Counter
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from formulas import reading, runner
from formulas.draws import draws
from numpy.typing import NDArray

SEED = int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))
Floats = NDArray[np.float64]


def logged(path: Path, *, arms: int, noise: float, seed: int, change: Any = None, rows: int = 1000) -> Path:
    """A log of the Jacobian; change(J, q, numbers) may spoil it, and the noise is relative to each entry's scale."""
    rng = np.random.default_rng(seed)
    names = ["q1", "q2", "q3", *(f"J{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)), "a2", "a3"]
    lines = []
    lengths = rng.uniform(0.5, 1.5, (arms, 2)) if arms > 1 else np.array([[0.8, 0.55]])
    for number in range(rows):
        a2, a3 = lengths[number % arms]
        numbers = {"a2": float(a2), "a3": float(a3), "m2": 1.0, "m3": 1.0, "g": 9.80665}
        q = rng.uniform(-3, 3, 3)
        values = runner.arm_of("simscape", numbers).jacobian(q)
        if change:
            change(values, q, numbers)
        values = values + noise * rng.standard_normal((3, 3)) * 1.5
        lines.append([*q, *values.ravel(), a2, a3])
    path.write_text(",".join(names) + "\n" + "\n".join(",".join(map(repr, map(float, line))) for line in lines))
    return path


def lose_a_sine(values: Floats, q: Floats, numbers: dict[str, float]) -> None:
    values[1, 2] = -numbers["a3"] * np.sin(q[1]) * np.sin(q[0])


@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_a_wrong_column_of_a_log_is_read(noise: float, tmp_path: Path) -> None:
    path = logged(tmp_path / "log.csv", arms=6, noise=noise, seed=SEED, change=lose_a_sine)
    verdict = verify.jacobian(path)
    (finding,) = verdict.findings
    assert (finding.entry, finding.due) == ([2, 3], "-a3 S1 S23"), str(verdict)
    number = r"-\((0\.99|1\.00)\d+ \+- 0\.00\d+\) " if noise else "-"
    assert re.fullmatch(f"{number}a3 S1 S2", finding.reads or ""), str(verdict)


@pytest.mark.parametrize("noise", [0.0, 1e-3])
@pytest.mark.parametrize("arms", [1, 6])
def test_a_right_log_is_right(noise: float, arms: int, tmp_path: Path) -> None:
    verdict = verify.formula_verdict(logged(tmp_path / "log.csv", arms=arms, noise=noise, seed=SEED))
    assert verdict.ok and verdict.kind == "jacobian", str(verdict)
    assert (noise == 0) == (not verdict.warnings)


def test_what_is_below_the_noise_is_no_finding(tmp_path: Path) -> None:
    def slightly(values: Floats, q: Floats, numbers: dict[str, float]) -> None:
        values[1, 2] *= 1 + 1e-5

    verdict = verify.jacobian(logged(tmp_path / "log.csv", arms=6, noise=1e-3, seed=SEED, change=slightly))
    assert verdict.ok and "cannot be judged" in verdict.warnings[0]


def test_a_run_is_a_log_of_its_inverse_dynamics(tmp_path: Path) -> None:
    scenario = arm3r.Scenario("{format: 1, initial: {qd: [0.4, 0.7, -0.5]}, time: {stop: 1, log_every: 0.1}}")
    path = tmp_path / "run.csv"
    scenario.run().to_csv(path)
    assert verify.inverse(path).ok


REFUSED = {
    "": "has no rows",
    "q1,q2,q3\n1,2,3\n": "no column is judged",
    "q1,q2,q3,g1\n1,2,x,4\n": ":2: q3 is a number",
    "q1,q2,q3,g1\n1,2\n": ":2: a row has 4 numbers",
    "g1\n1\n": "has the columns q1, q2, q3",
    "q1,q2,q3,g7\n1,2,3,4\n": "has no entry",
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_is_no_log_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(text)
    with pytest.raises(arm3r.UsageError, match=REFUSED[text]):
        verify.formula_verdict(path)


def added(share: float, which: str, place: tuple[int, int]) -> Any:
    """The change that adds a term to an entry."""

    def change(values: Floats, q: Floats, numbers: dict[str, float]) -> None:
        values[place] += share * numbers[which] * np.cos(q[1]) * np.sin(q[0])

    return change


@pytest.mark.parametrize("noise", [0.0, 1e-3, 1e-2])
@pytest.mark.parametrize("share", [0.137, 0.1, -0.503])
def test_a_number_is_said_as_far_as_the_noise_allows(share: float, noise: float, tmp_path: Path) -> None:
    """No fraction is said because it is near: 0.503 is not 1/2, and 0.1 may be 1/8 under the noise."""
    print(f"ARM3R_SEED={SEED}")
    change = added(share, "a3", (1, 2))
    verdict = verify.jacobian(logged(tmp_path / "log.csv", arms=6, noise=noise, seed=SEED, change=change))
    (finding,) = verdict.findings
    assert is_true(finding.reads or "0", change, (1, 2)), str(verdict)
    assert ("+-" in str(finding.reads)) == (noise > 0)


@pytest.mark.gate
def test_many_wrong_logs_with_noise(tmp_path: Path) -> None:
    """Wrong terms of at least 0.05 of the entry's scale under noise of 1e-3: located always, nothing false said."""
    outcomes: Counter[str] = Counter()
    for choose in itertools.islice(draws(SEED), 300):
        place = choose.choice([(0, 1), (1, 0), (1, 2), (2, 1), (2, 2)])
        share = choose.choice([-2.0, -1.0, 0.5, 0.1, -0.3, choose.uniform(0.08, 1)])
        change = added(share, choose.choice(["a2", "a3"]), place)
        seed, noise = choose.randrange(10**9), choose.choice([1e-3, 10 ** choose.uniform(-5, -3)])
        verdict = verify.jacobian(logged(tmp_path / "log.csv", arms=6, noise=noise, seed=seed, change=change))
        assert [finding.entry for finding in verdict.findings] == [[place[0] + 1, place[1] + 1]], (seed, place, share)
        finding = verdict.findings[0]
        assert finding.reads is None or is_true(finding.reads, change, place), str(verdict)
        outcomes["read" if finding.reads else "unnamed"] += 1
    assert outcomes["read"] >= 297, outcomes


def is_true(sentence: str, change: Any, place: tuple[int, int]) -> bool:
    """Whether an entry with a change reads so, at another arm and other states."""
    numbers = {"a2": 0.83, "a3": 0.57, "m2": 1.0, "m3": 1.0, "g": 9.80665}
    for q in runner.STATES:
        values = runner.arm_of("simscape", numbers).jacobian(q)
        change(values, q, numbers)
        said, allowed = reading.interval(sentence, q, numbers)
        if abs(said - values[place]) > allowed + 1e-9:
            return False
    return True


@pytest.mark.parametrize(
    ("kind", "words"),
    [("gravity", "no column is that of a gravity torque; name them g1.."), ("controller", "is judged as a function")],
)
def test_a_kind_that_the_log_has_not_is_said(tmp_path: Any, kind: str, words: str) -> None:
    rows = "\n".join(",".join(map(str, row)) for row in np.random.default_rng(3).uniform(-1, 1, (12, 4)))
    (tmp_path / "log.csv").write_text(f"q1,q2,q3,J11\n{rows}\n")
    with pytest.raises(arm3r.UsageError, match=words):
        verify.formula_verdict(tmp_path / "log.csv", kind)


def poses(path: Path, kinds: list[str], names: list[str], *, factor: float = 1.0) -> Path:
    """A log of the lecture's arm at random poses; the first kind is a factor times what is right."""
    q = np.random.default_rng(7).uniform(-2, 2, (60, 3))
    arm = arm3r.Scenario().arm
    values = {"gravity": arm.gravity_torque(q), "mass": arm.mass_matrix(q), "kinematics": arm.tip_position(q)}
    columns = [values[kind].reshape(60, -1) * (factor if kind == kinds[0] else 1.0) for kind in kinds]
    table = np.concatenate([np.arange(60.0)[:, None], q, *columns], axis=1)
    np.savetxt(path, table, delimiter=",", header=",".join(names), comments="", fmt="%.17g")
    return path


def test_a_column_without_a_name_is_passed_over(tmp_path: Path) -> None:
    """As tables of pandas have one, with the number of the row."""
    path = poses(tmp_path / "log.csv", ["gravity"], ["", "q1", "q2", "q3", "g1", "g2", "g3"])
    verdict = verify.formula_verdict(path)
    assert verdict.ok and verdict.kind == "gravity", str(verdict)


def test_what_a_log_holds_beside_its_subject_is_not_judged_in_its_place(tmp_path: Path) -> None:
    entries = [f"M{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)]
    names = ["row", "q1", "q2", "q3", *entries, "p1", "p2", "p3"]
    verdict = verify.formula_verdict(poses(tmp_path / "log.csv", ["mass", "kinematics"], names, factor=1.1))
    assert verdict.kind == "mass" and not verdict.ok
