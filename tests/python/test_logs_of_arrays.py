"""Logs in the files of numpy and MATLAB: the same verdicts as on a text, and one line for what cannot be read."""

from __future__ import annotations

from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from arm3r_cpp.errors import UsageError
from random_scenarios import sample_seed

ROWS = 40


@pytest.fixture
def arrays() -> dict[str, np.ndarray]:
    """Of a log of the lecture's arm: angles, their gravity torque, the Jacobian in pages."""
    q = np.random.default_rng(sample_seed()).uniform(-2, 2, (ROWS, 3))
    arm = arm3r.Scenario().arm
    return {"time": np.arange(ROWS) * 0.1, "q": q, "tau_g": arm.gravity_torque(q), "J": arm.jacobian(q)}


def written(folder: Path, ending: str, arrays: dict[str, np.ndarray]) -> Path:
    path = folder / f"log.{ending}"
    if ending == "npz":
        np.savez(path, **arrays)
    elif ending == "npy":
        columns = {f"{name}{i + 1}": arrays[name][:, i] for name in ("q", "tau_g") for i in range(3)}
        np.save(path, np.rec.fromarrays(list(columns.values()), names=list(columns)))
    else:
        pytest.importorskip("scipy.io").savemat(path, {"robot": {"log": arrays}} if ending == "struct.mat" else arrays)
    return path


@pytest.mark.parametrize("ending", ["npz", "npy", "mat", "struct.mat"])
def test_right_arrays_are_right_and_a_wrong_column_is_named(tmp_path: Path, arrays, ending: str) -> None:
    assert verify.gravity(written(tmp_path, ending, arrays)).ok
    if ending != "npy":
        assert verify.jacobian(written(tmp_path, ending, arrays)).ok
    arrays["tau_g"][:, 2] *= 1.05
    verdict = verify.gravity(written(tmp_path, ending, arrays))
    assert [one.entry for one in verdict.findings] == [[3]]


def test_samples_may_stand_in_columns_and_names_may_be_said(tmp_path: Path, arrays) -> None:
    turned = {"q": arrays["q"].T, "tau_g": arrays["tau_g"].T, "J": np.moveaxis(arrays["J"], 0, 2), "note": np.eye(2)}
    path = written(tmp_path, "npz", turned)
    assert verify.gravity(path).ok and verify.jacobian(path).ok
    np.save(tmp_path / "plain.npy", np.hstack([arrays["q"], arrays["tau_g"]]))
    names = {str(i + 1): name for i, name in enumerate(("q1", "q2", "q3", "g1", "g2", "g3"))}
    assert verify.formula_verdict(tmp_path / "plain.npy", columns=names).ok
    with pytest.raises(UsageError, match="--columns NAME=q1"):
        verify.gravity(tmp_path / "plain.npy")


def test_rows_with_nan_are_left_out_and_named(tmp_path: Path, arrays) -> None:
    arrays["q"][4, 1] = np.nan
    verdict = verify.gravity(written(tmp_path, "npz", arrays))
    assert verdict.ok and any("NaN" in one and "5" in one for one in verdict.warnings)


VERSION_7_3 = b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM"


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("a.npy", b"", "cannot be read"),
        ("a.npy", b"\x93NUMPY\x01\x00", "cannot be read"),
        ("a.npz", b"PK\x03\x04", "cannot be read"),
        ("a.npz", b"q1,q2\n", "cannot be read"),
        ("a.mat", b"", "cannot be read"),
        ("a.mat", bytes(range(200)), "cannot be read"),
        ("a.mat", VERSION_7_3, r"it is of version 7.3; in MATLAB: save\('log.mat', 'q', 'tau', '-v7'\)"),
    ],
)
def test_what_is_no_such_file_is_one_line(tmp_path: Path, name: str, data: bytes, words: str) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(UsageError, match=words) as raised:
        verify.gravity(tmp_path / name)
    assert "\n" not in str(raised.value)


def test_arrays_of_objects_are_not_opened(tmp_path: Path) -> None:
    """They hold programs."""
    np.save(tmp_path / "a.npy", np.array([{"q": 1}], object), allow_pickle=True)
    with pytest.raises(UsageError, match="cannot be read"):
        verify.gravity(tmp_path / "a.npy")


@pytest.mark.parametrize("arrays", [{"q": np.zeros(3)}, {"text": np.array(["a"])}, {}, {"q": np.zeros((300, 300))}])
def test_arrays_without_rows_are_refused(tmp_path: Path, arrays) -> None:
    np.savez(tmp_path / "a.npz", **arrays)
    with pytest.raises(UsageError):
        verify.gravity(tmp_path / "a.npz")
