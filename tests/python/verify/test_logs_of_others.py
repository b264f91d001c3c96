"""Logs as people bring them: other columns beside, friction, delays, units, and what a smooth motion hides."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm3r_cpp import UnjudgedError
from arm3r_cpp.commands.verify import main
from arm3r_cpp.verify.functions import Chain, formula_verdict, truth_of
from arm3r_cpp.verify.kinds import KINDS
from numpy.typing import NDArray
from random_scenarios import sample_seed
from test_noisy_logs import coloured, states, white

Floats = NDArray[np.float64]
HEAD = "standard\ntype,a,alpha,d,theta,mass,cx,cy,cz,Ixx,Iyy,Izz\n"
PUMA = HEAD + (
    "R,0,1.5707963267948966,0.66,0,9.1,0,-0.1,0,0.2,0.2,0.2\n"
    "R,0.43,0,0.15,0,17.4,-0.2,0.01,0.02,0.13,0.52,0.54\n"
    "R,0.4,0,-0.03,0,4.8,-0.25,0.02,0.01,0.07,0.09,0.09\n"
)
PLANAR = HEAD + "R,0.4,0,0,0,1.5,-0.18,0,0,0,0.02,0.02\nR,0.3,0,0,0,0.9,-0.17,0,0,0,0.01,0.01\n"
SCARA = HEAD + (
    "R,0.35,0,0.4,0,6,-0.17,0,0.01,0.02,0.09,0.1\n"
    "R,0.25,3.141592653589793,0,0,3.5,-0.1,0.01,0,0.01,0.04,0.04\n"
    "P,0,0,0.1,0,1.3,0.01,0,-0.05,0.01,0.01,0.002\n"
)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(sample_seed())


@pytest.fixture
def of_table(tmp_path: Path) -> Any:
    def chain(table: str) -> Chain:
        (tmp_path / "arm.csv").write_text(table)
        return Chain.from_dh(tmp_path / "arm.csv")

    return chain


def log(path: Path, **columns: Floats) -> Path:
    """A vector's columns are numbered from 1, a matrix's by row and column."""
    names, parts = [], []
    for name, values in columns.items():
        rest = np.asarray(values).reshape(len(values), -1)
        places = ("".join(str(one + 1) for one in place) for place in np.ndindex(*np.shape(values)[1:]))
        names += [f"{name}{place}" for place in places] if np.ndim(values) > 1 else [name]
        parts.append(rest)
    np.savetxt(path, np.hstack(parts), fmt="%.12g", delimiter=",", header=",".join(names), comments="")
    return path


def due(truth: Any, kind: str, at: dict[str, Floats]) -> Floats:
    return np.asarray(truth.values(KINDS[kind], truth.convention, at, {}))


def motion(rng: np.random.Generator, rows: int = 1000, joints: int = 3) -> dict[str, Floats]:
    at = states(rows, moves=True, rng=rng)
    return {name: values[:, :joints] for name, values in at.items()}


# ---- what is no noise ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("noise", [0.0, 0.003])
def test_another_length_in_the_rows_of_several_arms_is_named(noise: float, rng: Any, tmp_path: Path) -> None:
    q, a2, a3 = rng.uniform(-3, 3, (400, 3)), rng.uniform(0.4, 1.2, 400), rng.uniform(0.3, 0.9, 400)
    (c1, s1), (c2, s2), (c23, s23) = ((np.cos(x), np.sin(x)) for x in (q[:, 0], q[:, 1], q[:, 1] + q[:, 2]))
    r, h, o = a2 * c2 + a3 * c23, a2 * s2 + a3 * s23, np.zeros(400)
    J = np.array([[-s1 * r, -c1 * h, -c1 * a2 * s23], [c1 * r, -s1 * h, -s1 * a3 * s23], [o, r, a3 * c23]])
    J = np.moveaxis(J, 2, 0) * np.array([[1], [1], [-1]])
    verdict = formula_verdict(log(tmp_path / "log.csv", q=q, a2=a2, a3=a3, J=white(J, noise, rng)))
    assert [one.entry for one in verdict.findings] == [[1, 3]], str(verdict)
    assert "a2 C1 S23, should be -a3 C1 S23" in str(verdict)


def test_what_is_far_off_beside_quiet_entries_is_not_called_right(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain = of_table(PUMA)
    for number in range(6):
        at = motion(rng)
        g = due(chain, "gravity", at)
        g[:, 2] = due(chain, "gravity", {"q": at["q"] * [1, 0, 1]})[:, 2]  # q2 is lost
        path = log(tmp_path / "log.csv", q=at["q"], g=white(g, 0.003 * np.abs(g).max(), rng))
        if np.abs(g - due(chain, "gravity", at)).max() < 0.1 * np.abs(g[:, 2]).max():
            continue
        try:
            assert not formula_verdict(path, arm=chain), number
        except UnjudgedError as refusal:
            assert "g3" in str(refusal) or "t3" in str(refusal)


def test_a_lost_torque_is_no_friction(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain = of_table(PUMA)
    for number in range(6):
        at = motion(rng)
        tau = due(chain, "inverse", at)
        lost = due(chain, "gravity", {"q": at["q"]})[:, 2]
        tau[:, 2] -= lost
        states = {name: at[name] for name in ("q", "qd", "qdd")}
        path = log(tmp_path / "log.csv", **states, tau=white(tau, 1e-3 * np.abs(tau).max(), rng))
        with suppress(UnjudgedError):
            assert not formula_verdict(path, arm=chain), number


def test_slow_noise_with_a_white_one_on_it_is_noise(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain = of_table(PUMA)
    for number in range(8):
        at = motion(rng, rows=int(rng.integers(300, 1200)))
        tau = due(chain, "inverse", at)
        size = 0.005 * np.abs(tau).max()
        states = {name: at[name] for name in ("q", "qd", "qdd")}
        path = log(tmp_path / "log.csv", **states, tau=white(coloured(tau, size, rng), size, rng))
        assert formula_verdict(path, arm=chain), number


def test_noise_in_one_entry_beside_exact_ones_is_left_open(rng: Any, tmp_path: Path) -> None:
    q = rng.uniform(-2, 2, (400, 3))
    g = due(truth_of(None), "gravity", {"q": q})
    g[:, 1] += 0.02 * rng.standard_normal(400)
    with pytest.raises(UnjudgedError, match=r"t2 is off by up to .*, as noise may be, beside entries without any"):
        formula_verdict(log(tmp_path / "log.csv", q=q, g=g))
    g[:, 2] *= 1.01
    verdict = formula_verdict(log(tmp_path / "log.csv", q=q, g=g))
    assert [one.entry for one in verdict.findings] == [[3]], str(verdict)


@pytest.mark.parametrize("rows", [8, 12, 19])
def test_few_rows_with_noise_tell_nothing(rows: int, rng: Any, tmp_path: Path) -> None:
    at = states(rows, moves=False, rng=rng)
    tau = white(due(truth_of(None), "inverse", at), 0.05, rng)
    path = log(tmp_path / "log.csv", q=at["q"], qd=at["qd"], qdd=at["qdd"], tau=tau)
    with pytest.raises(UnjudgedError, match=f"{rows} rows do not tell a mistake from noise; 20 or more do"):
        formula_verdict(path)


def test_a_torque_that_is_too_large_as_a_whole_is_found(rng: Any, tmp_path: Path) -> None:
    for number in range(6):
        at = motion(rng, rows=800)
        tau = due(truth_of(None), "inverse", at)
        tau[:, 2] *= 1.2
        noisy = tau + 0.03 * np.std(tau, axis=0) * rng.standard_normal(tau.shape)
        path = log(tmp_path / "log.csv", q=at["q"], qd=at["qd"], qdd=at["qdd"], tau=noisy)
        verdict = formula_verdict(path)
        assert [3] in [one.entry for one in verdict.findings], (number, str(verdict))


# ---- friction --------------------------------------------------------------------------------------------------------


def test_friction_may_be_another_one_each_way(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain, at = of_table(PUMA), motion(rng)
    qd = at["qd"]
    tau = due(chain, "inverse", at) + np.where(qd > 0, 5 + 3 * qd, -4 + 2 * qd)
    verdict = formula_verdict(log(tmp_path / "log.csv", q=at["q"], qd=qd, qdd=at["qdd"], tau=tau), arm=chain)
    assert verdict.ok and str(verdict).count("as friction does") == 3, str(verdict)


def test_a_torque_that_drives_the_joint_is_no_friction(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain, at = of_table(PUMA), motion(rng)
    tau = due(chain, "inverse", at) - 2 * at["qd"]
    verdict = formula_verdict(log(tmp_path / "log.csv", q=at["q"], qd=at["qd"], qdd=at["qdd"], tau=tau), arm=chain)
    assert not verdict.ok and "friction" not in str(verdict)


def test_a_joint_that_turns_one_way_tells_no_friction(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain, at = of_table(PUMA), motion(rng)
    t = np.linspace(0, 2, len(at["q"]))
    at["q"][:, 0], at["qd"][:, 0], at["qdd"][:, 0] = t + 0.1 * t**2, 1 + 0.2 * t, 0.2
    tau = due(chain, "inverse", at)
    tau[:, 0] += 4
    path = log(tmp_path / "log.csv", q=at["q"], qd=at["qd"], qdd=at["qdd"], tau=white(tau, 0.01, rng))
    with pytest.raises(UnjudgedError, match=r"t1 is off by up to 4.*turns one way only.*turns both ways"):
        formula_verdict(path, arm=chain)


# ---- what columns mean -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["g", "grav", "m", "l", "I"])
def test_columns_that_are_no_numbers_of_the_arm_are_left_out(name: str, rng: Any, tmp_path: Path) -> None:
    truth = truth_of(None)
    q = rng.uniform(-2, 2, (300, 3))
    others = rng.integers(0, 2, 300) if name.startswith("g") else rng.uniform(-3, 3, (300, 3))
    path = log(tmp_path / "log.csv", q=q, **{name: others}, J=due(truth, "jacobian", {"q": q}))
    assert formula_verdict(path).ok
    path = log(tmp_path / "log.csv", q=q, **{name: others}, tau=due(truth, "gravity", {"q": q}))
    verdict = formula_verdict(path)
    assert verdict.ok and f"without its column{'' if name.startswith('g') else 's'} {name}" in str(verdict), str(
        verdict
    )


def test_a_log_of_a_chain_has_the_freedoms_of_a_formula(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain = of_table(PLANAR)
    q = rng.uniform(-2, 2, (300, 2))
    g = due(chain.placed(gravity=(0, -9.81, 0)), "gravity", {"q": q})
    verdict = formula_verdict(log(tmp_path / "log.csv", q=q, g=g), arm=chain)
    assert verdict.ok and "g = 9.81 m/s^2 along [0, -1, 0]" in str(verdict), str(verdict)
    J = np.asarray(chain.geometric_jacobian(q))
    assert formula_verdict(log(tmp_path / "log.csv", q=q, J=J), arm=chain).ok
    verdict = formula_verdict(log(tmp_path / "log.csv", q=q, J=J[:, [0, 1, 5]]), arm=chain)
    assert verdict.ok and "third row about z" in str(verdict), str(verdict)
    assert formula_verdict(log(tmp_path / "log.csv", q=q, J=J[:, :2]), arm=chain).ok


def test_degrees_are_those_of_joints_that_turn(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain = of_table(SCARA)
    q = rng.uniform(-1, 1, (300, 3)) * [3, 3, 0.2]
    p = np.round(due(chain, "kinematics", {"q": q}), 7)
    verdict = formula_verdict(log(tmp_path / "log.csv", q=q * [180 / np.pi, 180 / np.pi, 1], p=p), arm=chain)
    assert verdict.ok and "angles in degrees" in str(verdict), str(verdict)


@pytest.mark.parametrize("late", [1, 2, -1])
def test_torques_that_come_late_are_right_then(late: int, rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain, at = of_table(PUMA), motion(rng, rows=600)
    tau = white(due(chain, "inverse", at), 0.02, rng)
    of_tau, of_states = (slice(None, -late), slice(late, None)) if late > 0 else (slice(-late, None), slice(None, late))
    at = {name: at[name][of_states] for name in ("q", "qd", "qdd")}
    verdict = formula_verdict(log(tmp_path / "log.csv", **at, tau=tau[of_tau]), arm=chain)
    rows = f"{abs(late)} row{'s' * (abs(late) > 1)} late"
    who = "tau1, tau2, tau3" if late > 0 else "all but what is judged"
    assert verdict.ok and f"{who} {rows}" in str(verdict), str(verdict)


@pytest.mark.parametrize(("factor", "words"), [(-1, "has the wrong sign"), (1000, "millimetres")])
def test_a_factor_that_makes_all_right_is_named(factor: int, words: str, rng: Any, tmp_path: Path) -> None:
    q = rng.uniform(-2, 2, (300, 3))
    verdict = formula_verdict(log(tmp_path / "log.csv", q=q, J=factor * due(truth_of(None), "jacobian", {"q": q})))
    assert not verdict.ok and {one.cause.count(words) for one in verdict.findings} == {1}, str(verdict)


def test_all_results_of_a_log_are_judged(rng: Any, tmp_path: Path, capsys: Any) -> None:
    q, truth = rng.uniform(-2, 2, (300, 3)), truth_of(None)
    J, g = due(truth, "jacobian", {"q": q}), due(truth, "gravity", {"q": q})
    tau = due(truth, "inverse", {"q": q, "qd": 0 * q, "qdd": 0 * q})
    assert main([str(log(tmp_path / "log.csv", q=q, J=J, g=2 * g, tau=tau))]) == 11
    out = capsys.readouterr().out
    assert "jacobian, convention simscape: right" in out and "gravity torque, convention simscape, 2 of 3" in out
    assert "not judged here: tau1, tau2, tau3 (--kind inverse)" in out


def test_the_head_says_how_far_what_is_wrong_is_off(rng: Any, of_table: Any, tmp_path: Path) -> None:
    chain = of_table(PUMA)
    q = rng.uniform(-2, 2, (400, 3))
    g = due(chain, "gravity", {"q": q})
    g[:, 2] *= 1.1
    verdict = formula_verdict(log(tmp_path / "log.csv", q=q, g=white(g, 0.3, rng)), arm=chain)
    assert [one.entry for one in verdict.findings] == [[3]], str(verdict)
    assert verdict.residual < 0.1 * np.abs(g[:, 2]).max() + 1.5
