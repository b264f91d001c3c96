"""Confines the process that runs a user's file: it computes, and reads what a program needs; nothing else."""

from __future__ import annotations

import ctypes
import glob
import os
import signal
import sys
from collections.abc import Iterable, Sequence

from .landlock import Readable, read_only
from .seccomp import refuse_system_calls

_PR_SET_PDEATHSIG, _PR_SET_DUMPABLE, _PR_CAPBSET_DROP, _PR_SET_SECUREBITS = 1, 4, 24, 28
_PR_SET_CHILD_SUBREAPER, _PR_SET_NO_NEW_PRIVS, _PR_CAP_AMBIENT = 36, 38, 47
_CLEAR_ALL, _HIGHEST_CAPABILITY = 4, 63
_NO_ROOT_LOCKED = 0b11101111  # securebits: no identity gives capabilities, none is kept or raised, locked
_CAPABILITY_VERSION_3 = 0x20080522
EVERYTHING = ("network", "files", "processes")
_SYSTEM = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/nix/store", "/usr/share/zoneinfo")
_FILES = ("/etc/ld.so.cache", "/etc/localtime", "/dev/null", "/dev/zero", "/dev/urandom", "/dev/random")


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def end_with_parent() -> None:
    """The kernel ends this process when its parent ends, and gives it the orphans of its descendants."""
    if sys.platform == "linux":
        libc = _libc()
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        libc.prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
        libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)


def confine(folder: str, hidden_package: str, readable: Sequence[str] = ()) -> list[str]:
    """This process gives up all privileges, all files but those that programs need, and all other processes.

    Args:
        folder: of the user's file, whose neighbours can be read; "" where there is none.
        hidden_package: the folder of a package that cannot be read, and no copy of it; "" where none is hidden.
        readable: other folders that the program which runs the file needs.

    Returns what could not be barred, some of `EVERYTHING`.
    """
    if sys.platform != "linux":
        return list(EVERYTHING)
    libc = _libc()
    _give_up_privileges(libc)
    can_bar_files = read_only(libc, _readable(folder, hidden_package, readable))
    if not refuse_system_calls(libc):
        return list(EVERYTHING)
    return [] if can_bar_files else ["files"]


def _give_up_privileges(libc: ctypes.CDLL) -> None:
    """No capability is left or can be gained, by root neither; no other process can look into this one.

    Raises:
        OSError: capabilities are left.
    """
    for capability in range(_HIGHEST_CAPABILITY + 1):
        libc.prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0)
    libc.prctl(_PR_SET_SECUREBITS, _NO_ROOT_LOCKED, 0, 0, 0)  # refused, as the line above, to who has none to lose
    libc.prctl(_PR_CAP_AMBIENT, _CLEAR_ALL, 0, 0, 0)
    head, none = (ctypes.c_uint32 * 2)(_CAPABILITY_VERSION_3, 0), (ctypes.c_uint32 * 6)()
    done = (
        libc.capset(head, none),
        libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0),
        libc.prctl(_PR_SET_DUMPABLE, 0, 0, 0, 0),
    )
    if any(done):
        raise OSError(ctypes.get_errno(), "the privileges of this process stay")


def _readable(folder: str, hidden_package: str, others: Sequence[str]) -> list[Readable]:
    """The system's libraries, Python's modules, the folder of the user's file, and others."""
    modules = [path for path in sys.path if os.path.isdir(path)]
    libraries = [*_SYSTEM, *(f"{prefix}/lib" for prefix in {sys.prefix, sys.base_prefix})]
    pythons = _found(libraries, "python3*")
    pythons += _found([*pythons, *modules], "*-packages")
    hidden = _real(_copies_of(hidden_package, [*libraries, *modules])) if hidden_package else frozenset()
    found = [Readable(path, hidden | _real(pythons) - _real([path])) for path in (*libraries, *modules)]
    found += [Readable(path, hidden) for path in others]
    found += [Readable(path) for path in _FILES]
    return [*found, Readable(folder, hidden, is_foreign=True)] if folder else found


def _copies_of(package: str, folders: list[str]) -> list[str]:
    """A package, and it and its library where they are installed elsewhere."""
    name = os.path.basename(package)
    library = f"lib{name.partition('_')[0]}*"
    return [package, *_found(folders, f"{name}*"), *_found(folders, library), *_found(list(_SYSTEM), f"*/{library}")]


def _found(folders: list[str], pattern: str) -> list[str]:
    return [path for folder in folders for path in glob.glob(f"{glob.escape(folder)}/{pattern}")]


def _real(paths: Iterable[str]) -> frozenset[str]:
    return frozenset(map(os.path.realpath, paths))
