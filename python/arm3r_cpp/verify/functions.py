"""The functions of `arm3r_cpp.verify`."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

from ..core.arm import Arm
from ..core.scenario import Scenario
from ..errors import UnjudgedError, UnreadError, UsageError
from ..user_functions.python_process import PythonProcess
from .explain.repair import Progress
from .formula import Formula, by_octave, from_callable, from_file, kind_of
from .judge import judge
from .kinds import KINDS
from .log.judge import judge_log
from .log.reading import ENDINGS, read_log
from .meaning import kind_by_arguments
from .told import told
from .truth.chain_files import Chain
from .truth.elbow import truth_of_arm
from .truth.three_r import ThreeR
from .verdict import Finding, Verdict

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = [
    "Chain",
    "Finding",
    "Verdict",
    "controller",
    "coriolis",
    "formula_verdict",
    "forward",
    "gravity",
    "inverse",
    "jacobian",
    "jacobian_dot",
    "kinematics",
    "mass",
]


class Told(TypedDict, total=False):
    """What may be said of a formula beside its arm, see `formula_verdict`."""

    seen_by: Sequence[Any]
    progress: Progress | None
    noise: float | None
    columns: Mapping[str, str] | None
    args: Sequence[str]
    given: Mapping[str, Any] | None


def truth_of(arm: Any) -> Any:
    """The truth for a scenario, an arm, a chain or a scenario's file; None is the lecture's arm."""
    if arm is None or isinstance(arm, (Scenario, Arm)):
        return truth_of_arm(arm)
    if isinstance(arm, (str, os.PathLike)):
        return truth_of_arm(Scenario.load(arm))
    if isinstance(arm, (Chain, ThreeR)):
        return arm
    raise UsageError(f"arm: a Scenario, an Arm, a Chain or the path of a scenario is needed, got {type(arm).__name__}")


def formula_verdict(
    f: Any,
    kind: str | None = None,
    arm: Any = None,
    *,
    seen_by: Sequence[Any] = (),
    progress: Progress | None = None,
    noise: float | None = None,
    columns: Mapping[str, str] | None = None,
    args: Sequence[str] = (),
    given: Mapping[str, Any] | None = None,
) -> Verdict:
    """Judge a formula: a function, sympy expressions, or the path of a file.

    Args:
        kind: one of `KINDS`; None: found from names.
        arm: a `Scenario`, an `Arm`, a `Chain`, or the path of a scenario; None: the lecture's arm.
        columns: of a log: what a column is, such as q1 or J12, by its name in the file; units in brackets: q1 [deg].
        args: what the function's arguments are, in their order: q, qd, q1, a2, or names that `given` has.
        given: values of arguments and of names that the text does not define: a number, a list; "p.l1" is a field.
        noise: of a log's numbers, relative to an entry's scale; None: what a fit shows.
        seen_by: tests, of which the verdict says whether they would have seen each mistake.

    Raises:
        UsageError: the file cannot be read, or the kind of the formula is not clear.
        UnjudgedError: what it holds is not read, or it is too slow.
    """
    try:
        return _verdict_of(f, kind, truth_of(arm), seen_by, progress, noise, columns, args, given or {})
    except RecursionError:
        raise UnjudgedError(f"{f}: cannot be judged: it is nested too deeply to be read") from None


def _verdict_of(
    f: Any,
    kind: str | None,
    truth: Any,
    seen_by: Sequence[Any],
    progress: Progress | None,
    noise: float | None,
    columns: Mapping[str, str] | None,
    args: Sequence[str],
    given: Mapping[str, Any],
) -> Verdict:
    if isinstance(f, (str, os.PathLike)) and os.fspath(f).endswith(ENDINGS):
        if args or given:
            raise UsageError(f"{f}: --args and --set say what a function needs; --columns is for a log")
        log = read_log(f, columns, truth.joint_names if isinstance(truth, Chain) else ())
        return judge_log(log, KINDS[kind] if kind else log.kind(), truth, noise=noise)

    def verdict_on(formula: Formula) -> Verdict:
        return _of_kind(told(formula, args, given), kind, truth, seen_by, progress)

    if isinstance(f, Formula):
        return verdict_on(f)
    if not isinstance(f, (str, os.PathLike)):
        return verdict_on(from_callable(f))
    try:
        return verdict_on(from_file(f, kind=kind, sandbox=PythonProcess))
    except UnreadError as refusal:
        formula = by_octave(f, refusal)
        if formula is None:
            raise
        why = f"{f' in line {refusal.line}' if refusal.line else ''} {refusal.reason}"
    try:
        return verdict_on(formula)
    except UnjudgedError as error:
        raise UnjudgedError(f"{error}; Octave was asked because{why}") from None


def _of_kind(
    formula: Formula, kind: str | None, truth: Any, seen_by: Sequence[Any], progress: Progress | None
) -> Verdict:
    """The verdict on a formula whose kind its names tell where it is not given."""
    chosen = KINDS[kind] if kind else kind_of(formula) or kind_by_arguments(formula, truth)
    if chosen is None:
        kinds = "|".join(KINDS)
        raise UsageError(f"{formula.file}: what {formula.name} computes is not clear; name it by --kind {kinds}")
    return judge(formula, chosen, truth, seen_by=seen_by, progress=progress)


def jacobian(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge the Jacobian of the tip: f(q) -> (3, n), or (6, n) with linear rows first."""
    return formula_verdict(f, "jacobian", arm, **told)


def jacobian_dot(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge the rate of the tip's Jacobian: f(q, qd) -> (3, n), or (6, n) with linear rows first."""
    return formula_verdict(f, "jacobian_dot", arm, **told)


def gravity(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge the torque that holds the arm: f(q) -> (n,), N m."""
    return formula_verdict(f, "gravity", arm, **told)


def kinematics(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge the tip's position: f(q) -> (3,), or (4, 4), m."""
    return formula_verdict(f, "kinematics", arm, **told)


def mass(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge the mass matrix: f(q) -> (n, n), kg m^2."""
    return formula_verdict(f, "mass", arm, **told)


def coriolis(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge the Coriolis and centrifugal torque: f(q, qd) -> (n,), or a matrix (n, n) by its product with qd, N m."""
    return formula_verdict(f, "coriolis", arm, **told)


def inverse(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge the inverse dynamics: f(q, qd, qdd) -> (n,), N m."""
    return formula_verdict(f, "inverse", arm, **told)


def forward(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge the forward dynamics: f(q, qd, tau) -> (n,), rad/s^2."""
    return formula_verdict(f, "forward", arm, **told)


def controller(f: Any, arm: Any = None, **told: Unpack[Told]) -> Verdict:
    """Judge a control law: f(q, qd) -> (n,), N m, against that of the scenario `arm`."""
    return formula_verdict(f, "controller", arm, **told)
