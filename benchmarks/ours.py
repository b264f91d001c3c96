"""Many runs through the C interface, as the other programs here race them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
from arm3r_cpp import _native
from arm3r_cpp._native import ffi, lib

BUILD = f"arm3r {arm3r.__version__}, {ffi.string(lib.arm3r_build_info()).decode()}"

FALLING = "format: 1\ntime: {stop: 2, log_every: 2}"
PUSHED = """
format: 1
wall: {acts_on_arm: true}
controller: {type: gravity_compensation}
time: {stop: 10, log_every: 10}
"""

# Every method, as a solver of a scenario, by its one setting.
SOLVERS: dict[str, Callable[[float], dict[str, Any]]] = {
    "rk4": lambda step: {"method": "rk4", "step": step},
    "dopri5": lambda rtol: {"method": "dopri5", "rtol": rtol, "atol": rtol * 1e-3},
    "taylor": lambda tol: {"method": "taylor", "tol": tol},
}


def _names() -> list[str]:
    name, unit, meaning = (ffi.new("const char **") for _ in range(3))
    names = []
    for index in range(lib.arm3r_summary_count()):
        _native.call(lib.arm3r_summary_column, index, name, unit, meaning)
        names.append(ffi.string(name[0]).decode())
    return names


NAMES = _names()


def known(method: str) -> bool:
    """Whether this library has a solver; says so where it has not."""
    try:
        arm3r.Scenario(f"format: 1\nsolver: {{method: {method}}}").validate()
    except arm3r.Arm3rError:
        print(f"skipped: arm3r {arm3r.__version__} has no solver {method}", file=sys.stderr)
        return False
    return True


class Batch:
    """n runs of a scenario that differ in numbers."""

    def __init__(
        self,
        text: str,
        varied: Mapping[str, np.ndarray],
        *,
        solver: Mapping[str, Any],
        threads: int = 1,
        lanes: int = 0,
        metrics: Sequence[str] | None = None,
    ) -> None:
        """`varied`: n values a number, by its name, such as "initial.q[1]". metrics: the table's columns; None: all."""
        scenario = arm3r.Scenario(text)
        self._solver = dict(solver)
        scenario["solver"] = self._solver
        self._params = scenario.params
        self._varied = np.array([arm3r.param_index(name) for name in varied], dtype=np.uintp)
        self._values = np.array(list(varied.values()), dtype=float)
        self.runs = self._values.shape[1]
        self._names = NAMES if metrics is None else list(metrics)
        self._results = np.empty((len(self._names), self.runs))
        self._options = ffi.new("arm3r_batch_options *", {"threads": threads, "lanes": lanes})
        self._options.struct_size = ffi.sizeof("arm3r_batch_options")
        if metrics is not None:
            self._summary = ffi.new("size_t[]", [NAMES.index(name) for name in metrics])
            self._options.summary, self._options.summary_size = self._summary, len(metrics)

    def run(self) -> None:
        _native.call(
            lib.arm3r_batch_run,
            _native.readable(self._params),
            self._params.size,
            ffi.from_buffer("size_t[]", self._varied),
            self._varied.size,
            _native.readable(self._values),
            self.runs,
            self._options,
            _native.writable(self._results),
        )
        failed = self["outcome"] != lib.ARM3R_RUN_OK
        if failed.any():
            why = ffi.string(lib.arm3r_outcome_name(int(self["outcome"][failed][0]))).decode()
            raise SystemExit(f"{self._solver}: {failed.sum()} of {self.runs} runs failed, the first as `{why}`")

    def __getitem__(self, name: str) -> np.ndarray:
        """A column of the last results: shape (runs,)."""
        return self._results[self._names.index(name)]

    @property
    def q(self) -> np.ndarray:
        """Final joint angles: (runs, 3), rad."""
        return np.stack([self["q1"], self["q2"], self["q3"]], axis=-1)


def poses(runs: int, *, spread: Sequence[float] = (5, 5, 5)) -> np.ndarray:
    """Random poses within `spread` degrees of the lecture's: (runs, 3), rad. Fewer runs are the first of more."""
    return np.radians([0, -30, 60] + np.random.default_rng(1).uniform(-1, 1, (runs, 3)) * spread)


def from_poses(q: np.ndarray) -> dict[str, Any]:
    """Start in these poses: what varies, for Batch."""
    return {f"initial.q[{joint}]": q[:, joint] for joint in range(3)}
