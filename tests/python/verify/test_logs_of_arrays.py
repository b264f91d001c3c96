"""Logs in the files of numpy and MATLAB: the same verdicts as on a text, and one line for what cannot be read."""

from __future__ import annotations

import random
from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from arm3r_cpp.errors import UnjudgedError, UsageError
from arm3r_cpp.logs.mat_file import MatFile
from mutations import mutated
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


def test_two_arrays_of_a_name_are_no_guess(tmp_path: Path, arrays) -> None:
    io = pytest.importorskip("scipy.io")
    io.savemat(tmp_path / "two.mat", {"first": arrays, "second": arrays})
    with pytest.raises(UsageError, match="two arrays are named 'time'"):
        verify.gravity(tmp_path / "two.mat")


@pytest.mark.parametrize("is_packed", [False, True])
def test_numbers_of_matlab_files_are_those_that_scipy_reads(tmp_path: Path, is_packed: bool) -> None:
    io, rng = pytest.importorskip("scipy.io"), np.random.default_rng(sample_seed())
    kinds = ["f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"]
    arrays = {f"of_{kind}": rng.integers(0, 99, rng.integers(2, 5, 3)).astype(kind) for kind in kinds}
    held = {"a": arrays["of_f8"], "inner": {"b": arrays["of_f4"][0]}, "text": "abc", "z": 1j * np.ones(3)}
    io.savemat(tmp_path / "a.mat", {**arrays, "s": held, "cells": np.array([1, "x"], object)}, do_compression=is_packed)
    found = MatFile((tmp_path / "a.mat").read_bytes()).variables
    other = io.loadmat(tmp_path / "a.mat", simplify_cells=True)
    for name in arrays:
        assert np.array_equal(found[name], other[name].squeeze()) and found[name].ndim > 0
    assert np.array_equal(found["s"]["a"], arrays["of_f8"].squeeze()) and np.array_equal(
        found["s"]["inner"]["b"], held["inner"]["b"].squeeze()
    )
    assert found["s"]["text"] is None and found["s"]["z"] is None and found["cells"] is None


def flipped(content: bytes, chance: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(chance.randint(1, 5)):
        changed[chance.randrange(min(len(changed), chance.choice([300, 10**6])))] = chance.randrange(256)
    return bytes(changed)


@pytest.mark.parametrize("count", [60, pytest.param(1000, marks=[pytest.mark.gate, pytest.mark.random])])
def test_random_changes_of_files_are_one_line_each(tmp_path: Path, arrays, count: int) -> None:
    """Some end a process that reads them by scipy."""
    chance = random.Random(sample_seed())
    files = [written(tmp_path, ending, arrays) for ending in ("npz", "npy", "mat", "struct.mat")]
    whole = [(path.suffix, path.read_bytes()) for path in files]
    whole.append((".npy", whole[0][1]))
    for _ in range(count):
        ending, content = chance.choice(whole)
        path = tmp_path / f"changed{ending}"
        path.write_bytes(chance.choice([mutated, flipped])(content, chance))
        try:
            verify.gravity(path)
        except (UsageError, UnjudgedError) as error:
            assert "\n" not in str(error)


@pytest.mark.parametrize("arrays", [{"q": np.zeros(3)}, {"text": np.array(["a"])}, {}, {"q": np.zeros((300, 300))}])
def test_arrays_without_rows_are_refused(tmp_path: Path, arrays) -> None:
    np.savez(tmp_path / "a.npz", **arrays)
    with pytest.raises(UsageError):
        verify.gravity(tmp_path / "a.npz")
