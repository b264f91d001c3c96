"""Noisy logs: none that is right is called wrong, whatever its noise; a wrong term of 5 % is found in each."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.verify.functions import formula_verdict, truth_of
from arm3r_cpp.verify.kinds import KINDS
from arm3r_cpp.verify.log.noise import features_of
from arm3r_cpp.verify.truth.three_r import ThreeR
from numpy.typing import NDArray
from random_scenarios import sample_seed

Floats = NDArray[np.float64]
NAMES = {
    "jacobian": [f"J{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3)],
    "gravity": ["g1", "g2", "g3"],
    "kinematics": ["p1", "p2", "p3"],
    "mass": [f"M{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3)],
    "coriolis": ["h1", "h2", "h3"],
    "inverse": ["tau1", "tau2", "tau3"],
    "forward": ["qdd1", "qdd2", "qdd3"],
}
STATES = {"coriolis": ("q", "qd"), "inverse": ("q", "qd", "qdd"), "forward": ("q", "qd", "tau")}
TRUTH = truth_of(None)


def states(rows: int, *, moves: bool, rng: np.random.Generator) -> dict[str, Floats]:
    """Random states, or those along a motion of a few sinusoids."""
    if not moves:
        widths = {"q": 3, "qd": 2, "qdd": 5, "tau": 10}
        return {name: rng.uniform(-width, width, (rows, 3)) for name, width in widths.items()}
    t = np.linspace(0, rng.uniform(2, 10), rows)[:, None, None]
    size, rate, phase = rng.uniform(0.1, 1, (3, 3)), rng.uniform(0.5, 6, (3, 3)), rng.uniform(0, 6, (3, 3))
    angle = rate * t + phase
    q = rng.uniform(-1.5, 1.5, 3) + np.sum(size * np.sin(angle), axis=2)
    qd, qdd = np.sum(size * rate * np.cos(angle), axis=2), -np.sum(size * rate**2 * np.sin(angle), axis=2)
    return {"q": q, "qd": qd, "qdd": qdd, "tau": 5 * np.sin(q + 1)}


def white(right: Floats, level: float, rng: np.random.Generator) -> Floats:
    return right + level * rng.standard_normal(right.shape)


def coloured(right: Floats, level: float, rng: np.random.Generator) -> Floats:
    memory, noise = rng.uniform(0.3, 0.97), rng.standard_normal(right.shape)
    for row in range(1, len(noise)):
        noise[row] = memory * noise[row - 1] + np.sqrt(1 - memory**2) * noise[row]
    return right + level * noise


def rounded(right: Floats, level: float, rng: np.random.Generator) -> Floats:
    return np.round(white(right, level * rng.choice([0, 0.3]), rng) / level) * level


def exact(right: Floats, level: float, rng: np.random.Generator) -> Floats:
    return right


def friction(qd: Floats, rng: np.random.Generator) -> Floats:
    """Of a real joint: dry, more of it at rest, and viscous."""
    dry = rng.uniform(0.1, 0.5, 3) * np.sign(qd) * (1 + 0.5 * np.exp(-((qd / 0.2) ** 2)))
    return dry + rng.uniform(0, 0.3, 3) * qd


def written(path: Path, kind: str, at: dict[str, Floats], values: Floats) -> Path:
    """The log as text."""
    used = STATES.get(kind, ("q",))
    names = [*(f"{name}{joint}" for name in used for joint in (1, 2, 3)), *NAMES[kind]]
    rows = np.column_stack([*(at[name] for name in used), values])
    np.savetxt(path, rows, fmt="%.15g", delimiter=",", header=",".join(names), comments="")
    return path


def drawn(number: int, rng: np.random.Generator) -> tuple[str, dict[str, Floats], Floats]:
    """A kind of formula, states, and what is due there."""
    kind = list(NAMES)[number % len(NAMES)]
    at = states(int(rng.integers(200, 2001)), moves=bool(rng.integers(2)), rng=rng)
    return kind, at, TRUTH.values(KINDS[kind], TRUTH.convention, at, {}).reshape(len(at["q"]), -1)


def right_logs(count: int, seed: int, path: Path) -> None:
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        kind, at, due = drawn(number, rng)
        noise = (white, coloured, rounded, exact)[int(rng.integers(4))]
        values = noise(due, 10 ** rng.uniform(-4, -2) * np.abs(due).max(), rng)
        verdict = formula_verdict(written(path, kind, at, values), kind)
        assert verdict.ok, (seed, number, noise.__name__, str(verdict))


def wrong_logs(count: int, seed: int, path: Path) -> Counter[Any]:
    """One entry has one term too many: of 5 % or 1 % of it, under a white noise of 1e-3 of the largest entry."""
    found: Counter[Any] = Counter()
    for number in range(count):
        rng = np.random.default_rng([seed, number, 1])
        kind, at, due = drawn(number, rng)
        large = np.abs(due).max(axis=0)
        entry = int(rng.choice(np.flatnonzero(large > 0.2 * large.max())))
        terms = features_of(KINDS[kind], TRUTH.groups, TRUTH.revolute, at, {})
        term = terms[:, rng.integers(terms.shape[1])]
        share = (0.05, 0.01)[number // len(NAMES) % 2]
        values = white(due, 1e-3 * large.max(), rng)
        values[:, entry] += share * large[entry] * term / np.abs(term).max()
        verdict = formula_verdict(written(path, kind, at, values), kind)
        place = [entry // 3 + 1, entry % 3 + 1] if len(NAMES[kind]) == 9 else [entry + 1]
        located = [one.entry for one in verdict.findings]
        assert located in ([], [place]), (seed, number, place, str(verdict))
        is_friction = f"t{place[0]} leaves" in str(verdict)  # the term follows the rate: no log tells the two apart
        found[share, bool(located) or is_friction] += 1
        if not located:
            print((seed, number), kind, place, verdict)
    print(dict(found))
    return found


def hold(count: int, seed: int, folder: Path) -> None:
    print(f"ARM3R_SEED={seed}")
    right_logs(count, seed, folder / "log.csv")
    found = wrong_logs(count, seed, folder / "log.csv")
    assert found[0.05, False] == 0 and found[0.01, False] <= 0.1 * (found[0.01, True] + found[0.01, False])


def test_noise_is_no_mistake_and_hides_none(tmp_path: Path) -> None:
    hold(14, sample_seed(), tmp_path)


@pytest.mark.gate
@pytest.mark.random
@pytest.mark.parametrize("part", range(4))
def test_noise_is_no_mistake_and_hides_none_in_many(part: int, tmp_path: Path) -> None:
    hold(500, sample_seed() + 1000 * part, tmp_path)


@pytest.mark.parametrize("kind", ["gravity", "inverse", "kinematics"])
def test_a_few_spikes_are_no_mistake_and_hide_none(kind: str, tmp_path: Path) -> None:
    rng = np.random.default_rng(sample_seed())
    for number in range(4):
        at = states(int(rng.integers(200, 2001)), moves=bool(rng.integers(2)), rng=rng)
        due = TRUTH.values(KINDS[kind], TRUTH.convention, at, {})[:, :3]
        size = np.abs(due).max()
        measured = white(due, 1e-3 * size, rng)
        rows = rng.choice(len(measured), int(rng.integers(1, 0.03 * len(measured))), replace=False)
        measured[rows, rng.integers(3)] += rng.uniform(5, 50, len(rows)) * size
        verdict = formula_verdict(written(tmp_path / "log.csv", kind, at, measured), kind)
        assert verdict.ok, (number, str(verdict))
        lines = ", ".join(str(row + 2) for row in sorted(rows)[:5])
        assert any(f"far from all others, as spikes are, left out: line {lines}" in one for one in verdict.warnings)
        entry = int(np.abs(due).max(axis=0).argmax())
        measured[:, entry] += 0.1 * size * np.cos(at["q"][:, 1])
        assert not formula_verdict(written(tmp_path / "log.csv", kind, at, measured), kind).ok, number


def test_what_is_wrong_in_a_range_of_a_state_is_no_spike(tmp_path: Path) -> None:
    """A branch that is taken at the end of a joint's range alone has few rows, which lie together."""
    rng = np.random.default_rng(sample_seed())
    for moves in (False, True):
        at = states(1000, moves=moves, rng=rng)
        due = TRUTH.values(KINDS["gravity"], TRUTH.convention, at, {})
        measured = white(due, 1e-3 * np.abs(due).max(), rng)
        measured[at["q"][:, 0] > np.quantile(at["q"][:, 0], 0.97), 1] += 20 * np.abs(due).max()
        path = written(tmp_path / "log.csv", "gravity", at, measured)
        try:
            verdict = formula_verdict(path, "gravity")
        except arm3r.UnjudgedError:
            continue
        assert not verdict.ok, str(verdict)


def test_the_friction_of_joints_is_no_mistake_and_is_said(tmp_path: Path) -> None:
    seed = sample_seed()
    for number in range(6):
        rng = np.random.default_rng([seed, number, 2])
        at = states(int(rng.integers(200, 2001)), moves=bool(rng.integers(2)), rng=rng)
        due = TRUTH.values(KINDS["inverse"], TRUTH.convention, at, {})
        measured = white(due + friction(at["qd"], rng), 1e-3 * np.abs(due).max(), rng)
        verdict = formula_verdict(written(tmp_path / "log.csv", "inverse", at, measured), "inverse")
        assert verdict.ok, (seed, number, str(verdict))
        assert sum("as friction does" in one for one in verdict.warnings) == 3, (seed, number, str(verdict))


def test_what_has_nothing_to_do_with_the_arm_is_not_judged(tmp_path: Path) -> None:
    rng = np.random.default_rng(sample_seed())
    at = states(300, moves=False, rng=rng)
    path = written(tmp_path / "log.csv", "gravity", at, rng.uniform(-20, 20, (300, 3)))
    with pytest.raises(arm3r.UnjudgedError, match=r"follows no term of a gravity torque; is this the arm"):
        formula_verdict(path)


# ---- what a log cannot tell ------------------------------------------------------------------------------------------


def motion(rows: int = 800) -> tuple[Floats, dict[str, Floats]]:
    """Times, and the states along a smooth motion."""
    t = np.linspace(0, 8, rows)
    rate, phase = np.array([1.3, 1.9, 2.3]), np.array([0.2, 1.1, 2.0])
    angle = rate * t[:, None] + phase
    return t, {"q": np.sin(angle), "qd": rate * np.cos(angle), "qdd": -(rate**2) * np.sin(angle)}


@pytest.mark.parametrize("noise", [1e-4, 2e-4])
def test_torques_of_measured_motion_are_right_where_their_states_are_noisy(noise: float, tmp_path: Path) -> None:
    """The torques are exact; rates and accelerations are differences of angles with noise."""
    rng = np.random.default_rng(sample_seed())
    t, at = motion()
    due = TRUTH.values(KINDS["inverse"], TRUTH.convention, at, {})
    q = white(at["q"], noise, rng)
    qd = np.gradient(q, t, axis=0)
    seen = {"q": q, "qd": qd, "qdd": np.gradient(qd, t, axis=0)}
    verdict = formula_verdict(written(tmp_path / "log.csv", "inverse", seen, due), "inverse")
    assert verdict.ok, str(verdict)
    assert "as the noise of the states explains" in str(verdict)
    wrong = formula_verdict(written(tmp_path / "log.csv", "inverse", at, due * [1, 1, 1.02]), "inverse")
    assert [one.entry for one in wrong.findings] == [[3]], str(wrong)


def test_a_torque_without_its_accelerations_is_right_at_rest_and_else_not_judged(tmp_path: Path) -> None:
    _, at = motion()
    still = {"q": at["q"], "qd": 0 * at["qd"], "qdd": 0 * at["qdd"]}
    for states_, is_judged in ((still, True), (at, False)):
        due = TRUTH.values(KINDS["inverse"], TRUTH.convention, states_, {})
        path = written(tmp_path / "log.csv", "inverse", states_, due)
        rows = np.loadtxt(path, delimiter=",", skiprows=1)
        names = ["q1", "q2", "q3", "qd1", "qd2", "qd3", "tau1", "tau2", "tau3"]
        np.savetxt(path, np.delete(rows, [6, 7, 8], axis=1), delimiter=",", header=",".join(names), comments="")
        if is_judged:
            verdict = formula_verdict(path)
            assert verdict.ok and "with qdd = 0, as the log has no columns of them" in str(verdict)
        else:
            with pytest.raises(arm3r.UnjudgedError, match=r"depends on qdd, and the log has no columns qdd1\.\.; add"):
                formula_verdict(path)


@pytest.mark.parametrize("held, judged", [((0,), False), ((1, 2), False), ((), True)])
def test_rows_in_which_a_joint_stands_still_are_not_judged(held: tuple[int, ...], judged: bool, tmp_path: Path) -> None:
    _, at = motion(300)
    at["q"][:, list(held)] = 0.4
    due = TRUTH.values(KINDS["jacobian"], TRUTH.convention, at, {}).reshape(300, -1)
    path = written(tmp_path / "log.csv", "jacobian", at, due)
    if judged:
        assert formula_verdict(path).ok
        return
    with pytest.raises(arm3r.UnjudgedError, match=r"the same in all rows, .* log rows in which every joint moves"):
        formula_verdict(path)
    due[:, 4] += 0.1  # what is wrong is wrong all the same
    assert not formula_verdict(written(path, "jacobian", at, due)).ok


def test_torques_that_cancel_leave_no_mistake(tmp_path: Path) -> None:
    run = arm3r.Scenario("{format: 1, initial: {qd: [0.4, 0.7, -0.5]}, time: {stop: 1, log_every: 0.05}}").run()
    run.to_csv(tmp_path / "run.csv")
    assert formula_verdict(tmp_path / "run.csv", "inverse").ok


def test_a_small_entry_beside_large_ones_of_the_same_noise_is_read(tmp_path: Path) -> None:
    rng = np.random.default_rng(sample_seed())
    at = states(400, moves=False, rng=rng)
    due = TRUTH.values(KINDS["gravity"], TRUTH.convention, at, {})
    verdict = formula_verdict(written(tmp_path / "log.csv", "gravity", at, white(due * [1, 1, -1], 0.05, rng)))
    assert [one.entry for one in verdict.findings] == [[3]], str(verdict)
    assert str(verdict.findings[0].reads).endswith(" C23") and verdict.findings[0].reads != verdict.findings[0].due


def test_a_log_of_the_other_convention_is_named_so(tmp_path: Path) -> None:
    scenario = arm3r.Scenario("format: 1\narm: {convention: slide, link2: {length: 0.8}}\n")
    rng = np.random.default_rng(sample_seed())
    at = states(300, moves=False, rng=rng)
    other = arm3r.Scenario("format: 1\narm: {convention: simscape, link2: {length: 0.8}}\n").arm
    values = white(other.gravity_torque(at["q"]), 0.01, rng)
    verdict = formula_verdict(written(tmp_path / "log.csv", "gravity", at, values), arm=scenario)
    assert not verdict.ok
    assert "it is right in the convention simscape; the scenario states slide" in verdict.alternatives


def test_columns_of_coriolis_terms_are_no_heights(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """h1 is a name of the height of joint 2, too: then each row would be of an arm of its own."""
    rng, arms = np.random.default_rng(sample_seed()), []
    at = states(400, moves=False, rng=rng)
    due = TRUTH.values(KINDS["coriolis"], TRUTH.convention, at, {})
    path = written(tmp_path / "log.csv", "coriolis", at, white(due, 1e-3 * np.abs(due).max(), rng))
    arm = ThreeR.arm
    monkeypatch.setattr(ThreeR, "arm", lambda self, *given, **more: arms.append(given) or arm(self, *given, **more))
    assert formula_verdict(path, "coriolis").ok
    assert len(arms) < 100
