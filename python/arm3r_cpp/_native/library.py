"""The library, loaded: where it is not built, or of another version, the import says so."""

from __future__ import annotations

import os
from contextlib import suppress
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import IncompatibleError


def _check_interpreter() -> None:
    """ImportError: this is a sub-interpreter. What the library calls back there would not arrive."""
    for name in ("_interpreters", "_xxsubinterpreters"):  # the second until Python 3.12
        with suppress(ImportError):
            interpreters = import_module(name)
            if interpreters.get_current() != interpreters.get_main():
                break
    else:
        return
    raise ImportError("arm3r_cpp works in the main interpreter of a process only, and this is a sub-interpreter")


_check_interpreter()
try:
    from .._arm3r import ffi as ffi
    from .._arm3r import lib as lib
except ModuleNotFoundError as missing:
    raise ImportError(
        f"{os.path.dirname(os.path.dirname(__file__))} holds the sources of arm3r_cpp, not built; `pip install .` "
        "builds and installs it, and Python must then not be started beside them"
    ) from missing

Floats = NDArray[np.float64]


def string(pointer: Any) -> str:
    return ffi.string(pointer).decode()


def _check_abi() -> None:
    found, expected = lib.arm3r_abi_version(), lib.ARM3R_ABI
    if found != expected:
        raise IncompatibleError(
            f"libarm3r.so speaks version {found} of the C interface (it is arm3r {version}), the Python extension "
            f"speaks version {expected}; install arm3r_cpp again, and look for another libarm3r.so in "
            f"LD_LIBRARY_PATH={os.getenv('LD_LIBRARY_PATH', '')} and LD_PRELOAD={os.getenv('LD_PRELOAD', '')}",
            status=lib.ARM3R_E_ABI,
            code="abi",
        )


version = string(lib.arm3r_version())
_check_abi()
