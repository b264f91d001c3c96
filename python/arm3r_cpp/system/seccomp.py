"""Seccomp: the only system calls that a process still has, for good and without any privilege (Linux)."""

from __future__ import annotations

import ctypes
import errno
import platform
from typing import NamedTuple

_ARCHITECTURES = {"x86_64": (0, 0xC000003E), "aarch64": (1, 0xC00000B7)}
# Numbers on x86_64 and aarch64; None where there is no such call.
# What computing and importing need: memory, threads' waiting, clocks, reading of files, and writing to what is open.
_ALLOWED: dict[str, tuple[int | None, int | None]] = {
    "pipe": (22, None), "pipe2": (293, 59),
    "read": (0, 63), "readv": (19, 65), "pread64": (17, 67), "write": (1, 64), "writev": (20, 66), "lseek": (8, 62),
    "close": (3, 57), "close_range": (436, 436), "dup": (32, 23), "dup2": (33, None), "dup3": (292, 24),
    "stat": (4, None), "fstat": (5, 80), "lstat": (6, None), "newfstatat": (262, 79), "statx": (332, 291),
    "statfs": (137, 43), "fstatfs": (138, 44), "access": (21, None), "faccessat": (269, 48), "faccessat2": (439, 439),
    "readlink": (89, None), "readlinkat": (267, 78), "getdents64": (217, 61),
    "getcwd": (79, 17), "chdir": (80, 49), "fchdir": (81, 50),
    "mmap": (9, 222), "mprotect": (10, 226), "munmap": (11, 215), "mremap": (25, 216), "madvise": (28, 233),
    "brk": (12, 214), "membarrier": (324, 283),
    "rt_sigaction": (13, 134), "rt_sigprocmask": (14, 135), "rt_sigreturn": (15, 139), "rt_sigpending": (127, 136),
    "rt_sigsuspend": (130, 133), "rt_sigtimedwait": (128, 137), "sigaltstack": (131, 132), "pause": (34, None),
    "alarm": (37, None), "getitimer": (36, 102), "setitimer": (38, 103), "restart_syscall": (219, 128),
    "poll": (7, None), "ppoll": (271, 73), "select": (23, None), "pselect6": (270, 72), "sched_yield": (24, 124),
    "nanosleep": (35, 101), "clock_nanosleep": (230, 115), "clock_gettime": (228, 113), "clock_getres": (229, 114),
    "gettimeofday": (96, 169), "time": (201, None), "times": (100, 153), "getrusage": (98, 165),
    "getpid": (39, 172), "getppid": (110, 173), "gettid": (186, 178), "getpgrp": (111, None), "getpgid": (121, 155),
    "getsid": (124, 156), "getuid": (102, 174), "geteuid": (107, 175), "getgid": (104, 176), "getegid": (108, 177),
    "getresuid": (118, 148), "getresgid": (120, 150), "getgroups": (115, 158), "getpriority": (140, 141),
    "getrlimit": (97, 163), "uname": (63, 160), "sysinfo": (99, 179), "getrandom": (318, 278), "getcpu": (309, 168),
    "sched_getaffinity": (204, 123), "sched_getparam": (143, 121), "sched_getscheduler": (145, 120),
    "sched_get_priority_max": (146, 125), "sched_get_priority_min": (147, 126),
    "futex": (202, 98), "set_robust_list": (273, 99), "set_tid_address": (218, 96), "rseq": (334, 293),
    "exit": (60, 93), "exit_group": (231, 94),
}  # fmt: skip


class _Condition(NamedTuple):
    """A call is allowed where an argument, by a mask, has one of these values."""

    numbers: tuple[int | None, int | None]
    argument: int
    mask: int
    values: tuple[int, ...]


_ALL = 0xFFFFFFFF
_WRITING = 0x3 | 0x40 | 0x200 | 0x400000  # O_ACCMODE, O_CREAT, O_TRUNC, the bit of O_TMPFILE
_THREAD, _OF_THREADS = 0x10000, 0x7D0F00  # CLONE_THREAD, and all that the C libraries start a thread with
_CONDITIONS = (
    _Condition((2, None), 1, _WRITING, (0,)),  # open: for reading
    _Condition((257, 56), 2, _WRITING, (0,)),  # openat
    _Condition((16, 29), 1, _ALL, (0x5401, 0x5450, 0x5451)),  # ioctl: is it a terminal, close on exec
    _Condition((72, 25), 1, _ALL, (0, 1, 2, 3, 1030)),  # fcntl: duplicates, flags; no owner, no signals, no locks
    _Condition((157, 167), 0, _ALL, (15, 16, 0x53564D41)),  # prctl: the names of threads and of memory
    _Condition((302, 261), 0, _ALL, (0,)),  # prlimit64: the limits of this process
    _Condition((56, 220), 0, _ALL & ~_OF_THREADS | _THREAD, (_THREAD,)),  # clone: a thread
)
_FIRST_NEW = 424  # programs do without the calls from this number on where a system does not know them

_LOAD, _AND, _EQUAL, _AT_LEAST, _RETURN = 0x20, 0x54, 0x15, 0x35, 0x06
_NUMBER, _ARCHITECTURE, _FIRST_ARGUMENT = 0, 4, 16  # offsets in seccomp_data
_ALLOW, _REFUSE = 0x7FFF0000, 0x00050000
_X32 = 0x40000000
_SECCOMP = (317, 277)
_SET_MODE_FILTER, _ALL_THREADS = 1, 1

Step = tuple[int, int, int, int]


class _Instruction(ctypes.Structure):
    _fields_ = [("code", ctypes.c_uint16), ("yes", ctypes.c_uint8), ("no", ctypes.c_uint8), ("k", ctypes.c_uint32)]


class _Program(ctypes.Structure):
    _fields_ = [("length", ctypes.c_uint16), ("instructions", ctypes.POINTER(_Instruction))]


def refuse_system_calls(libc: ctypes.CDLL) -> bool:
    """From now on all calls fail but the allowed ones, in every thread; False where the system has no such filter.

    The process must have set PR_SET_NO_NEW_PRIVS.
    """
    machine = platform.machine()
    if machine not in _ARCHITECTURES:
        return False
    column, architecture = _ARCHITECTURES[machine]
    steps = _steps(column, architecture)
    program = _Program(len(steps), (_Instruction * len(steps))(*(_Instruction(*step) for step in steps)))
    return bool(libc.syscall(_SECCOMP[column], _SET_MODE_FILTER, _ALL_THREADS, ctypes.byref(program)) == 0)


def _steps(column: int, architecture: int) -> list[Step]:
    """The filter's program: calls of another architecture and those that no line allows are refused."""
    allow: Step = (_RETURN, 0, 0, _ALLOW)
    steps: list[Step] = [
        (_LOAD, 0, 0, _ARCHITECTURE),
        (_EQUAL, 1, 0, architecture),
        (_RETURN, 0, 0, _REFUSE | errno.EPERM),
        (_LOAD, 0, 0, _NUMBER),
    ]
    for numbers in _ALLOWED.values():
        if (number := numbers[column]) is not None:
            steps += [(_EQUAL, 0, 1, number), allow]
    for condition in _CONDITIONS:
        if (number := condition.numbers[column]) is not None:
            tests = [step for value in condition.values for step in ((_EQUAL, 0, 1, value), allow)]
            body = [
                (_LOAD, 0, 0, _FIRST_ARGUMENT + 8 * condition.argument),
                (_AND, 0, 0, condition.mask),
                *tests,
                (_RETURN, 0, 0, _REFUSE | errno.EPERM),
            ]
            steps += [(_EQUAL, 0, len(body), number), *body]
    return [
        *steps,
        (_AT_LEAST, 2, 0, _X32),
        (_AT_LEAST, 0, 1, _FIRST_NEW),
        (_RETURN, 0, 0, _REFUSE | errno.ENOSYS),
        (_RETURN, 0, 0, _REFUSE | errno.EPERM),
    ]
