"""Landlock: a process gives up writing files for good, without any privilege (Linux 5.13 and later)."""

from __future__ import annotations

import ctypes

_CREATE_RULESET, _RESTRICT_SELF = 444, 446  # system calls, the same number on every architecture
_VERSION = 1  # flag: ask for the version of the interface
_WRITING = [1, *range(4, 13)]  # bits: write a file, remove and make entries of folders of every kind
_LATER = {2: 13, 3: 14}  # bits by version: move between folders, truncate
_TCP = 0b11  # bind and connect, from version 4


class _Ruleset(ctypes.Structure):
    _fields_ = [("files", ctypes.c_uint64), ("network", ctypes.c_uint64)]


def forbid_writing(libc: ctypes.CDLL) -> bool:
    """No file or folder is made, changed, moved or removed any more; False where the system has no Landlock.

    The process must have set PR_SET_NO_NEW_PRIVS. Files that are open stay as they are.
    """
    version = libc.syscall(_CREATE_RULESET, None, ctypes.c_size_t(0), _VERSION)
    if version < 3:
        return False
    bits = [*_WRITING, *(bit for first, bit in _LATER.items() if version >= first)]
    rules = _Ruleset(sum(1 << bit for bit in bits), _TCP if version >= 4 else 0)
    size = ctypes.sizeof(rules) if version >= 4 else ctypes.sizeof(ctypes.c_uint64)
    ruleset = libc.syscall(_CREATE_RULESET, ctypes.byref(rules), ctypes.c_size_t(size), 0)
    return bool(ruleset >= 0 and libc.syscall(_RESTRICT_SELF, ruleset, 0) == 0)
