"""Where the installed scripts start. Ctrl-C ends them by the signal, also while their modules are loaded."""

import signal
import sys
import warnings
from importlib import import_module

from ..answers import unseen_figures

_OURS = signal.getsignal(signal.SIGINT) is signal.default_int_handler  # not where the caller ignores the signal
if _OURS:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def plot() -> int:
    return _call("plot")


def sweep() -> int:
    return _call("sweep")


def animate() -> int:
    return _call("animate")


def converge() -> int:
    return _call("converge")


def docs() -> int:
    return _call("docs")


def examples() -> int:
    return _call("examples")


def export() -> int:
    return _call("interchange.export")


def verify() -> int:
    return _call("verify")


def run() -> int:
    return _call("run")


def exercise() -> int:
    return _call("exercise")


def import_urdf() -> int:
    return _call("interchange.import_urdf")


def live() -> int:
    return _call("live")


def view() -> int:
    return _call("view")


def _call(module: str) -> int:
    warnings.showwarning = _say  # type: ignore[assignment]
    unseen_figures.silence()
    main = import_module(f".{module}", __package__).main
    if _OURS:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return main(sys.argv[1:])
    except KeyboardInterrupt:
        from ..system.processes import end_by_interrupt

        end_by_interrupt()


def _say(message: object, *_: object) -> None:
    from .._messages import shown

    print(f"warning: {shown(str(message))}", file=sys.stderr)
