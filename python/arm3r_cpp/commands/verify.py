"""arm3r-verify: is a user's formula right, and if not, which term is wrong?"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from .._messages import as_json
from .._progress_bar import Bar
from ..errors import Arm3rError, UsageError
from ..verify.kinds import KINDS
from .exit_codes import UNJUDGED, WRONG_FORMULA, attempt, exit_code, print_line, say

if TYPE_CHECKING:
    from ..verify.verdict import Verdict

PROGRAM = "arm3r-verify"


EXAMPLES = """\
A file holds a function of the joint angles that returns numbers: in Python `def jacobian(q)` or
`def gravity(q1, q2, q3)`, in MATLAB `function J = jacobian(q)`. Its name says what it computes, or --kind.
GNU Octave, where it is installed on Linux, evaluates what is not read of a MATLAB file.

  arm3r verify my_jacobian.m my_gravity.m      against the lecture's arm
  arm3r verify dynamics.py:mass_matrix --arm my_arm.yaml
  arm3r verify log.csv                         columns q1 q2 q3 and J11.. or g1..
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-verify`; argv without the program's name. Returns an exit code, one of those of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    codes: list[int] = []
    code = attempt(PROGRAM, lambda: verify(options, codes))
    return code or next((one for one in (WRONG_FORMULA, UNJUDGED) if one in codes), max(codes, default=0))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=PROGRAM,
        description="Judge formulas of the arm: exit code 0 if all are right, 11 if one is wrong, 12 if one "
        "cannot be judged.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add(
        "formulas",
        nargs="+",
        metavar="FILE[:FUNCTION]",
        help="a Python or MATLAB file, a log, a library.so:SYMBOL",
    )
    add("--kind", choices=KINDS, help="what the formulas compute (default: found from names)")
    _add_arm(parser)
    add("--seen-by", action="append", default=[], metavar="TEST", help="a scenario or log: would it show the mistakes?")
    add(
        "--noise",
        type=float,
        metavar="X",
        help="noise of a log, relative to an entry's scale (default: estimated by a fit)",
    )
    add(
        "--columns",
        action="extend",
        default=[],
        type=pairs,
        metavar="FILE=OURS,...",
        help="what the columns of a log are, such as joint_a=q1,jac_12=J12; units in brackets: angle=q1[deg]",
    )
    add(
        "--args",
        type=names,
        default=[],
        metavar="NAME,...",
        help="what the function's arguments are, in their order: q, qd, q1, a2, or names that --set gives values",
    )
    add(
        "--set",
        action="append",
        default=[],
        type=setting,
        metavar="NAME=VALUE",
        help="value of an argument or of a name that the file lacks: a number or [1, 2]; p.l1 is a field of p",
    )
    add("--json", action="store_true", help="print the verdicts as a JSON array")
    return parser


def _add_arm(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    arm = parser.add_mutually_exclusive_group()
    arm.add_argument("--arm", metavar="SCENARIO", help="the arm that they are meant for (default: the lecture's)")
    arm.add_argument("--urdf", metavar="FILE", help="the arm is this serial chain of up to 7 joints")
    arm.add_argument("--dh", metavar="FILE", help="the same, as a DH table: `arm3r docs verify` says how it is written")
    add("--tip", metavar="LINK", help="of a URDF: the link whose frame is the tip (default: the last one)")
    add(
        "--gravity",
        type=vector,
        metavar="X,Y,Z",
        help="in the base frame, m/s^2 (default: the arm's own); with a minus first: --gravity=-9.81,0,0",
    )
    add("--base-rotation", type=angles, metavar="R,P,Y", help="of a chain: roll, pitch, yaw of its base, rad or 90deg")
    add("--payload", type=float, metavar="KG", help="a mass at the tip")


def names(text: str) -> list[str]:
    """ "q,qd,p"."""
    found = [one.strip() for one in text.split(",")]
    if not all(one.isidentifier() for one in found):
        raise argparse.ArgumentTypeError(f"names with commas between them are needed, got {text!r}")
    return found


def setting(text: str) -> tuple[str, Any]:
    """ "p.l1=0.5", "m=[1, 2]"."""
    name, _, value = text.partition("=")
    try:
        return name.strip(), json.loads(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"NAME=NUMBER or NAME=[NUMBER, ...] is needed, got {text!r}") from None


def pairs(text: str) -> list[tuple[str, str]]:
    """ "a=q1,b=q2": a is q1, and b is q2."""
    found = [(one.rpartition("=")[0].strip(), one.rpartition("=")[2].strip()) for one in text.split(",")]
    if not all(name and ours for name, ours in found):
        raise argparse.ArgumentTypeError(f"NAME=q1,... is needed, got {text!r}")
    return found


def vector(text: str) -> list[float]:
    """ "0,0,-9.81"."""
    try:
        found = list(map(float, text.split(",")))
    except ValueError:
        found = []
    if len(found) != 3 or not all(map(math.isfinite, found)):
        raise argparse.ArgumentTypeError(f"three numbers with commas between them are needed, got {text!r}")
    return found


def angles(text: str) -> list[float]:
    """ "1.57,0,0" or "90deg,0,0"."""
    units = [math.radians(1.0) if one.endswith("deg") else 1.0 for one in text.split(",")]
    return [unit * value for unit, value in zip(units, vector(text.replace("deg", "")), strict=True)]


def verify(options: argparse.Namespace, codes: list[int]) -> None:
    """Judge each formula: its exit code. What one cannot be judged for is said, and the others are judged."""
    from ..user_functions.python_process import PythonProcess

    PythonProcess.report = say_once

    arm = arm_of(options)
    verdicts: list[Verdict] = []
    for formula in options.formulas:
        for verdict in verdicts_on(formula, arm, options, codes):
            verdicts.append(verdict)
            codes.append(0 if verdict.ok else WRONG_FORMULA)
            if not options.json:
                print_line(verdict)
    if options.json:
        print_line(as_json([verdict.to_dict() for verdict in verdicts]))
    elif verdicts and (len(verdicts) > 1 or not verdicts[0].ok):
        print_line(summary(verdicts))


def verdicts_on(formula: str, arm: Any, options: argparse.Namespace, codes: list[int]) -> Iterator[Verdict]:
    """The verdict on a formula; on each kind that a function returns or a log has, where none is asked for."""
    from ..verify.log.reading import ENDINGS

    first = verdict_on(formula, options.kind, arm, options, codes)
    if first is None:
        return
    is_log = formula.endswith(ENDINGS)
    others: list[str] = []
    if options.kind is None:
        found = [KINDS[kind] for kind in dict.fromkeys(first.not_judged.values())]
        of_one = KINDS[first.kind].comes_with
        others = [one.name for one in found if (not one.is_logged_anyway if is_log else one.name in of_one)]
    beside = [verdict_on(formula, kind, arm, options, codes) for kind in others]
    together = [first, *(one for one in beside if one is not None and (is_log or one.shape))]
    judged = {one.kind for one in together}
    for one in together:
        one.not_judged = {name: kind for name, kind in one.not_judged.items() if kind not in judged}
        yield one


def verdict_on(
    formula: str, kind: str | None, arm: Any, options: argparse.Namespace, codes: list[int]
) -> Verdict | None:
    """The verdict on a formula of one kind; None where it cannot be judged, which is said and among the codes."""
    from ..verify.functions import formula_verdict

    bar = Bar("repair", "edits")
    try:
        return formula_verdict(
            formula,
            kind,
            arm,
            seen_by=options.seen_by,
            progress=bar.draw,
            noise=options.noise,
            columns=dict(options.columns),
            args=options.args,
            given=dict(options.set),
        )
    except Arm3rError as error:
        say(PROGRAM, error)
        codes.append(exit_code(error))
        return None
    finally:
        bar.clear()


def arm_of(options: argparse.Namespace) -> Any:
    """The arm that formulas are judged by, as the options change it.

    Raises:
        UsageError: an option does not go with the arm.
    """
    from ..core.scenario import Scenario
    from ..verify.functions import Chain, truth_of

    given = {"payload": options.payload, "gravity": options.gravity}
    given = {name: value for name, value in given.items() if value is not None}
    if options.tip and not options.urdf:
        raise UsageError("--tip: it names a link of --urdf")
    if options.urdf or options.dh:
        chain = Chain.from_urdf(options.urdf, tip=options.tip) if options.urdf else Chain.from_dh(options.dh)
        return chain.placed(**given, base_rotation=options.base_rotation)
    if options.base_rotation:
        raise UsageError("--base-rotation: it turns the base of --urdf or --dh; a scenario has arm.gravity")
    if not given:
        return truth_of(options.arm)
    scenario = Scenario.load(options.arm) if options.arm else Scenario()
    paths = {"payload": "arm.payload.mass", "gravity": "arm.gravity"}
    scenario.update({paths[name]: value for name, value in given.items()})
    return truth_of(scenario)


def say_once(unbarred: list[str]) -> None:
    """Say what this system cannot keep a user's file from, once."""
    from ..user_functions.python_process import PythonProcess

    PythonProcess.report = None
    say(PROGRAM, f"this system cannot bar a formula from: {', '.join(unbarred)}")


def summary(verdicts: Sequence[Verdict]) -> str:
    """ "2 mistakes in 2 files"; entries that one edit mends are one mistake."""
    count = sum(
        len({(one.line, one.column, one.old, one.cause if one.old is None else "") for one in verdict.findings})
        for verdict in verdicts
    )
    files = len({verdict.file for verdict in verdicts})
    return f"{count or 'no'} mistake{'' if count == 1 else 's'} in {files} file{'' if files == 1 else 's'}"


if __name__ == "__main__":
    sys.exit(main())
