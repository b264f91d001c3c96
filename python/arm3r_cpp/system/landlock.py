"""Landlock: a process gives up all files but some for good, without any privilege (Linux 5.13 and later)."""

from __future__ import annotations

import contextlib
import ctypes
import os
import stat
import sys
from collections.abc import Iterable, Iterator
from typing import NamedTuple

_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446  # system calls, the same numbers on every architecture
_VERSION = 1  # flag: ask for the version of the interface
_BENEATH = 1  # kind of a rule: a file, or a folder with all in it
_FIRST_RIGHTS = (1 << 13) - 1  # of version 1: execute, write, read, list, remove and make entries
_LATER_RIGHTS = {2: 1 << 13, 3: 1 << 14, 5: 1 << 15}  # move between folders, truncate, control devices
_READ_FILE, _READ_FOLDER = 1 << 2, 1 << 3
_TCP = 0b11  # bind and connect, from version 4
_OUTSIDE = 0b11  # abstract Unix sockets and signals to processes outside, from version 6


class Readable(NamedTuple):
    """A file or folder that stays readable, with all in it but what is hidden."""

    path: str
    hidden: frozenset[str] = frozenset()
    """Real paths."""
    is_foreign: bool = False
    """Whether its links and what begins with a dot are hidden, too."""


class _Ruleset(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint64) for name in ("files", "network", "scopes")]


class _Beneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = [("allowed", ctypes.c_uint64), ("parent", ctypes.c_int32)]


def read_only(libc: ctypes.CDLL, readable: Iterable[Readable]) -> bool:
    """From now on these files alone can be opened, and for reading; False where the system has no Landlock.

    The process must have set PR_SET_NO_NEW_PRIVS. Files that are open stay as they are.
    """
    version = libc.syscall(_CREATE_RULESET, None, ctypes.c_size_t(0), _VERSION)
    if version < 1:
        return False
    rights = _FIRST_RIGHTS | sum(bit for first, bit in _LATER_RIGHTS.items() if version >= first)
    rules = _Ruleset(rights, _TCP if version >= 4 else 0, _OUTSIDE if version >= 6 else 0)
    size = 8 * (1 + (version >= 4) + (version >= 6))
    ruleset = libc.syscall(_CREATE_RULESET, ctypes.byref(rules), ctypes.c_size_t(size), 0)
    if ruleset < 0:
        return False
    for one in readable:
        for path, right in _rules(one):
            _allow(libc, ruleset, path, right, one.is_foreign)
    is_done = libc.syscall(_RESTRICT_SELF, ruleset, 0) == 0
    os.close(ruleset)
    return bool(is_done)


def _rules(one: Readable, is_link: bool = True) -> Iterator[tuple[str, int]]:
    """Paths, and what is allowed beneath them; a folder that holds something hidden is taken apart.

    Args:
        is_link: whether a part of the path may be one.
    """
    real = os.path.realpath(one.path) if is_link else one.path
    is_apart = one.is_foreign or any(hidden.startswith(real.rstrip("/") + "/") for hidden in one.hidden)
    if real in one.hidden:
        return
    if not (is_apart and os.path.isdir(real)):
        yield real, _READ_FILE | _READ_FOLDER
        return
    yield real, _READ_FOLDER
    with contextlib.suppress(OSError), os.scandir(real) as entries:
        for entry in entries:
            if not (one.is_foreign and (entry.name.startswith(".") or entry.is_symlink())):
                yield from _rules(Readable(entry.path, one.hidden), entry.is_symlink())


def _allow(libc: ctypes.CDLL, ruleset: int, path: str, right: int, is_foreign: bool) -> None:
    """What is not there, or cannot be reached, stays barred. Where a link has come into a foreign path, too."""
    if sys.platform != "linux":
        return
    try:
        file = os.open(path, os.O_PATH | os.O_CLOEXEC | (os.O_NOFOLLOW if is_foreign else 0))
    except OSError:
        return
    mode = os.fstat(file).st_mode
    if not stat.S_ISDIR(mode):
        right &= _READ_FILE
    if stat.S_ISDIR(mode) or stat.S_ISREG(mode) or stat.S_ISCHR(mode):
        libc.syscall(_ADD_RULE, ruleset, _BENEATH, ctypes.byref(_Beneath(right, file)), 0)
    os.close(file)
