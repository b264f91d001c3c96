"""Seccomp: system calls that a process refuses itself for good, without any privilege (Linux)."""

from __future__ import annotations

import ctypes
import errno
import platform
from collections.abc import Iterable

_ARCHITECTURES = {"x86_64": (0, 0xC000003E), "aarch64": (1, 0xC00000B7)}
# Numbers on x86_64 and aarch64; None where there is no such call.
_CALLS: dict[str, tuple[int | None, int | None]] = {
    "socket": (41, 198), "socketpair": (53, 199),
    "fork": (57, None), "vfork": (58, None),
    "kill": (62, 129), "tkill": (200, 130), "tgkill": (234, 131), "pidfd_open": (434, 434),
    "pidfd_send_signal": (424, 424), "rt_sigqueueinfo": (129, 138), "rt_tgsigqueueinfo": (297, 240),
    "ptrace": (101, 117), "process_vm_writev": (311, 271), "setpriority": (141, 140), "ioprio_set": (251, 30),
    "sched_setscheduler": (144, 119), "sched_setaffinity": (203, 122),
    "chmod": (90, None), "fchmod": (91, 52), "fchmodat": (268, 53), "fchmodat2": (452, 452),
    "chown": (92, None), "lchown": (94, None), "fchown": (93, 55), "fchownat": (260, 54),
    "utime": (132, None), "utimes": (235, None), "futimesat": (261, None), "utimensat": (280, 88),
    "setxattr": (188, 5), "lsetxattr": (189, 6), "fsetxattr": (190, 7),
    "removexattr": (197, 14), "lremovexattr": (198, 15), "fremovexattr": (199, 16),
    "shmget": (29, 194), "msgget": (68, 186), "semget": (64, 190), "mq_open": (240, 180),
    "add_key": (248, 217), "keyctl": (250, 219), "io_uring_setup": (425, 425),
    "unshare": (272, 97), "setns": (308, 268),
}  # fmt: skip
_CLONE, _CLONE3, _PRLIMIT = (56, 220), 435, (302, 261)
OTHERS = tuple(name for name in _CALLS if name != "unshare")
"""What reaches beyond the process: sockets, other processes, the attributes of files, objects of the kernel."""

_LOAD, _EQUAL, _AT_LEAST, _ANY_BIT, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
_NUMBER, _ARCHITECTURE, _FIRST_ARGUMENT = 0, 4, 16  # offsets in seccomp_data
_ALLOW, _REFUSE = 0x7FFF0000, 0x00050000
_CLONE_THREAD, _X32 = 0x10000, 0x40000000
_PR_SET_SECCOMP, _MODE_FILTER = 22, 2


class _Instruction(ctypes.Structure):
    _fields_ = [("code", ctypes.c_uint16), ("yes", ctypes.c_uint8), ("no", ctypes.c_uint8), ("k", ctypes.c_uint32)]


class _Program(ctypes.Structure):
    _fields_ = [("length", ctypes.c_uint16), ("instructions", ctypes.POINTER(_Instruction))]


def refuse(libc: ctypes.CDLL, names: Iterable[str], *, new_processes: bool = False) -> bool:
    """From now on these calls fail with EPERM; False where the system has no such filter.

    The process must have set PR_SET_NO_NEW_PRIVS. The filter passes on to all that the process starts.

    Args:
        new_processes: whether starting processes is refused, too; threads are not.
    """
    machine = platform.machine()
    if machine not in _ARCHITECTURES:
        return False
    column, architecture = _ARCHITECTURES[machine]
    numbers = [number for name in names if (number := _CALLS[name][column]) is not None]
    steps = [*_head(architecture), *(step for number in numbers for step in _refused(number))]
    if new_processes:
        steps += [*_refused(_CLONE3, errno.ENOSYS), *_unless(_CLONE[column], _ANY_BIT, _CLONE_THREAD)]
        steps += _unless(_PRLIMIT[column], _EQUAL, 0)  # the limits of this process alone
    steps.append((_RETURN, 0, 0, _ALLOW))
    code = (_Instruction * len(steps))(*(_Instruction(*step) for step in steps))
    program = _Program(len(steps), code)
    return bool(libc.prctl(_PR_SET_SECCOMP, _MODE_FILTER, ctypes.byref(program), 0, 0) == 0)


def _head(architecture: int) -> list[tuple[int, int, int, int]]:
    """Calls of another architecture are refused; then the number of the call is at hand."""
    return [
        (_LOAD, 0, 0, _ARCHITECTURE),
        (_EQUAL, 1, 0, architecture),
        (_RETURN, 0, 0, _REFUSE | errno.EPERM),
        (_LOAD, 0, 0, _NUMBER),
        (_AT_LEAST, 0, 1, _X32),
        (_RETURN, 0, 0, _REFUSE | errno.EPERM),
    ]


def _refused(number: int, error: int = errno.EPERM) -> list[tuple[int, int, int, int]]:
    return [(_EQUAL, 0, 1, number), (_RETURN, 0, 0, _REFUSE | error)]


def _unless(number: int, test: int, value: int) -> list[tuple[int, int, int, int]]:
    """A call is refused unless its first argument passes a test."""
    return [
        (_EQUAL, 0, 4, number),
        (_LOAD, 0, 0, _FIRST_ARGUMENT),
        (test, 1, 0, value),
        (_RETURN, 0, 0, _REFUSE | errno.EPERM),
        (_RETURN, 0, 0, _ALLOW),
    ]
