"""Confines the process that runs a user's file, in namespaces of its own where the system has them."""

from __future__ import annotations

import ctypes
import os
import signal
import sys

from .landlock import forbid_writing
from .seccomp import OTHERS, refuse

_NEWUSER, _NEWNS, _NEWPID, _NEWNET, _NEWIPC = 0x10000000, 0x00020000, 0x20000000, 0x40000000, 0x08000000
_MS_PRIVATE, _MS_REC = 1 << 18, 1 << 14
_SYS_MOUNT_SETATTR, _AT_FDCWD, _AT_RECURSIVE, _ATTR_RDONLY = 442, -100, 0x8000, 1
_PR_SET_PDEATHSIG, _PR_SET_CHILD_SUBREAPER, _PR_SET_NO_NEW_PRIVS = 1, 36, 38
EVERYTHING = ("network", "files", "processes")


class _MountAttributes(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint64) for name in ("set", "clear", "propagation", "namespace")]


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def end_with_parent() -> None:
    """The kernel ends this process when its parent ends, and gives it the orphans of its descendants."""
    if sys.platform == "linux":
        libc = _libc()
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        libc.prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
        libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)


def confine() -> list[str]:
    """Cut this process off in namespaces of its own, and go on in a child that is the first process in them.

    The parent stays behind, and ends as the child. Where the system refuses namespaces, the process restricts itself.
    Returns what could not be barred, some of `EVERYTHING`.
    """
    if sys.platform != "linux":
        return list(EVERYTHING)
    libc = _libc()
    user, group = os.getuid(), os.getgid()
    everything = _NEWUSER | _NEWNS | _NEWPID | _NEWNET | _NEWIPC
    if libc.unshare(everything) != 0:
        return _restrict_itself(libc)
    for name, text in (("setgroups", "deny"), ("uid_map", f"{user} {user} 1"), ("gid_map", f"{group} {group} 1")):
        try:
            with open(f"/proc/self/{name}", "w") as file:
                file.write(text)
        except OSError:
            pass
    open_to = [] if _make_files_read_only(libc) else ["files"]
    child = os.fork()
    if child:
        _end_as(child)
    end_with_parent()
    libc.mount(b"proc", b"/proc", b"proc", 0, None)  # only the processes of this namespace, where it is allowed
    return open_to


def _restrict_itself(libc: ctypes.CDLL) -> list[str]:
    """Where there are no namespaces: this process gives up writing, sockets, and reaching or starting processes."""
    unbarred = [] if forbid_writing(libc) else ["files"]
    return unbarred if refuse(libc, OTHERS, new_processes=True) else ["network", *unbarred, "processes"]


def _make_files_read_only(libc: ctypes.CDLL) -> bool:
    if libc.mount(b"none", b"/", None, _MS_REC | _MS_PRIVATE, None) != 0:
        return False
    attributes = _MountAttributes(set=_ATTR_RDONLY)
    size = ctypes.c_size_t(ctypes.sizeof(attributes))
    result = libc.syscall(_SYS_MOUNT_SETATTR, _AT_FDCWD, b"/", _AT_RECURSIVE, ctypes.byref(attributes), size)
    return bool(result == 0)


def _end_as(child: int) -> None:
    """Wait for the child and end in the same way."""
    null = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(null, descriptor)
    os.closerange(3, 256)
    _, status = os.waitpid(child, 0)
    os._exit(os.waitstatus_to_exitcode(status) & 0xFF)
