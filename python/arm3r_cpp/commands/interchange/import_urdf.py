"""arm3r-import: a URDF as a scenario."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from ..exit_codes import attempt, print_line

EXAMPLES = """\
An elbow arm has three revolute joints: axis 2 across axis 1, axis 3 parallel to axis 2. Other joints on the way to
the tip are locked; what hangs beside the way is counted, with its joints at zero. Angles are in rad, or such as -90deg.

  arm3r import ur5.urdf --tip tool0 --lock wrist_1_joint=-90deg --lock wrist_2_joint=-90deg --lock wrist_3_joint=0
  arm3r import arm.urdf > arm.yaml && arm3r run arm.yaml
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-import`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    usage = parser()
    options = usage.parse_args(sys.argv[1:] if argv is None else argv)
    if options.keys is not None:
        return show_keys(options.keys)
    if options.urdf is None:
        usage.error("the name of a URDF is needed")
    return attempt("arm3r-import", lambda: show(options))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-import",
        description="Print a scenario whose arm is that of a URDF.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("urdf", nargs="?", metavar="FILE.urdf", help="the file; of a xacro file, what `xacro` makes of it")
    add("--keys", metavar="REQUEST", help="print the keys alone, for a scenario that says all this as JSON")
    add(
        "--joints",
        type=lambda text: text.split(","),
        metavar="A,B,C",
        help="the joints that move, from base to tip (default: the first three that are not locked)",
    )
    add(
        "--lock",
        action="append",
        default=[],
        type=locked,
        metavar="NAME=ANGLE",
        help="a joint that is held at an angle",
    )
    add("--tip", metavar="LINK", help="the link whose frame is the tip (default: the only one without a child)")
    add("--axis-tolerance", metavar="X", help="by which angle axes may be off those of an elbow arm (default: 1e-6)")
    return parser


def locked(text: str) -> tuple[str, str]:
    """ "wrist=-90deg"."""
    name, equals, angle = text.rpartition("=")
    if not (name and equals):
        raise argparse.ArgumentTypeError(f"NAME=ANGLE is needed, got {text!r}")
    return name, angle


def show_keys(request: str) -> int:
    """Print the keys of the arm that a scenario asks for; with exit code 1, what is wrong."""
    from ...robots.explicit import answer

    status, text = answer(request)
    sys.stdout.write(text)
    return status


def show(options: argparse.Namespace) -> None:
    from ...robots.choice import Choice
    from ...robots.start_scenario import start_scenario

    given = {"joints": options.joints, "tip": options.tip, "axis_tolerance": options.axis_tolerance}
    request = {"urdf": options.urdf, "lock": dict(options.lock)}
    request |= {name: value for name, value in given.items() if value is not None}
    print_line(start_scenario(Choice.of(request)))


if __name__ == "__main__":
    sys.exit(main())
