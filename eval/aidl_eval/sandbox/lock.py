"""Locks this process: after `lock` it can compute and write to the files that it has open, and nothing else.

Several layers, because none is everywhere:

    network namespace   Linux, as root or where users may have namespaces: no network but an unconnected one
    system calls        Linux on x86-64 and ARM64: a list of those that computing takes; each other is refused
    limits              all of POSIX: no new descriptor (so no file and no socket), no process, and so much
                        memory, processor time and output
    audit hook          everywhere: what Python itself would open, start or load is refused with a word

Where there is no list of system calls (macOS, other processors), names in folders could still be changed by
a program that gets around the audit hook: `has_filter` says so, and the caller asks before it runs anything.
"""

from __future__ import annotations

import ctypes
import os
import platform
import resource
import sys
from collections.abc import Callable, Iterable, Sequence

_X86_64: dict[str, int] = {
    "read": 0, "write": 1, "close": 3, "fstat": 5, "lseek": 8, "mmap": 9, "mprotect": 10, "munmap": 11,
    "brk": 12, "rt_sigaction": 13, "rt_sigprocmask": 14, "rt_sigreturn": 15, "sched_yield": 24, "mremap": 25,
    "madvise": 28, "nanosleep": 35, "getpid": 39, "exit": 60, "gettimeofday": 96, "getrusage": 98,
    "sigaltstack": 131, "gettid": 186, "time": 201, "futex": 202, "restart_syscall": 219,
    "clock_gettime": 228, "clock_getres": 229, "clock_nanosleep": 230, "exit_group": 231, "getrandom": 318,
}  # fmt: skip
_ARM64: dict[str, int] = {
    "read": 63, "write": 64, "close": 57, "fstat": 80, "lseek": 62, "mmap": 222, "mprotect": 226,
    "munmap": 215, "brk": 214, "rt_sigaction": 134, "rt_sigprocmask": 135, "rt_sigreturn": 139,
    "sched_yield": 124, "mremap": 216, "madvise": 233, "nanosleep": 101, "getpid": 172, "exit": 93,
    "gettimeofday": 169, "getrusage": 165, "sigaltstack": 132, "gettid": 178, "futex": 98,
    "restart_syscall": 128, "clock_gettime": 113, "clock_getres": 114, "clock_nanosleep": 115,
    "exit_group": 94, "getrandom": 278,
}  # fmt: skip
_MACHINES = {"x86_64": (0xC000003E, _X86_64), "aarch64": (0xC00000B7, _ARM64)}
"""By machine: its mark in the kernel, and the numbers of the calls that are allowed."""

_NEWNET, _NEWUSER = 0x40000000, 0x10000000
_NO_NEW_PRIVILEGES, _SECCOMP, _FILTER = 38, 22, 2
_ALLOW, _REFUSE, _KILL = 0x7FFF0000, 0x00050001, 0x80000000
_UNKNOWN = 0x00050026
_LOAD, _EQUAL, _AT_LEAST, _ANY_BIT, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
_CLONE3, _CLONE, _THREAD = 435, {0xC000003E: 56, 0xC00000B7: 220}, 0x10000
_OTHER_NUMBERS = 0x40000000
"""From here on x86-64 has the same calls by other numbers (x32)."""

_REFUSED = (
    "open", "socket.", "subprocess.", "os.", "ctypes.", "shutil.", "tempfile.", "pty.", "fcntl.", "signal.",
    "mmap.", "glob.", "urllib.", "ftplib.", "http.", "smtplib.", "sqlite3.", "webbrowser.", "winreg.",
    "msvcrt.", "resource.", "syslog.", "marshal.", "code.__new__", "gc.", "sys.settrace", "sys.setprofile",
    "sys.addaudithook", "cpython.", "import ",
)  # fmt: skip
"""Audit events that are refused, by how they begin."""
_TAKEN = ("os.putenv", "os.unsetenv", "open_code")


def leave_network() -> bool:
    """Leaves the network for an empty one, before any thread runs; false where that is not allowed."""
    if not sys.platform.startswith("linux"):
        return False
    unshare = ctypes.CDLL(None, use_errno=True).unshare
    return bool(unshare(_NEWNET) == 0 or unshare(_NEWUSER | _NEWNET) == 0)


def has_filter() -> bool:
    """Tells whether system calls can be refused here."""
    return sys.platform.startswith("linux") and platform.machine() in _MACHINES


def lock(memory: int, seconds: int, output: int) -> None:
    """Locks this process for good. `memory` and `output` are bytes. Raises OSError if a layer fails."""
    refuse = _filter() if has_filter() else None
    limits = {
        resource.RLIMIT_CPU: seconds,
        resource.RLIMIT_AS: memory,
        resource.RLIMIT_FSIZE: output,
        resource.RLIMIT_CORE: 0,
        resource.RLIMIT_NPROC: 0,
        resource.RLIMIT_NOFILE: 0,  # what is open stays open; nothing more can be
    }
    for limit, value in limits.items():
        resource.setrlimit(limit, (value, value))
    if refuse is not None:
        refuse()
    sys.addaudithook(_hook)


def _hook(event: str, arguments: Sequence[object]) -> None:
    if event.startswith(_REFUSED) and event not in _TAKEN:
        raise PermissionError(f"`{event}` is not allowed: no files, no network, no other processes")


def _filter() -> Callable[[], None]:
    mark, calls = _MACHINES[platform.machine()]
    numbers = list(calls.values())
    count = len(numbers)
    return sealed(
        (_LOAD, 0, 0, 4),
        (_EQUAL, 1, 0, mark),
        (_RETURN, 0, 0, _KILL),
        (_LOAD, 0, 0, 0),
        *((_EQUAL, count - place, 0, number) for place, number in enumerate(numbers)),
        (_RETURN, 0, 0, _REFUSE),
        (_RETURN, 0, 0, _ALLOW),
    )


def refuse(numbers: Iterable[int]) -> None:
    """Has the kernel refuse these system calls, and new processes, to this one and what it becomes. Raises
    OSError.
    """
    mark, _ = _MACHINES[platform.machine()]
    sealed(
        (_LOAD, 0, 0, 4),
        (_EQUAL, 1, 0, mark),
        (_RETURN, 0, 0, _KILL),
        (_LOAD, 0, 0, 0),
        (_EQUAL, 0, 1, _CLONE3),
        (_RETURN, 0, 0, _UNKNOWN),  # its flags cannot be read; `clone` is used instead
        (_EQUAL, 0, 4, _CLONE[mark]),
        (_LOAD, 0, 0, 16),
        (_ANY_BIT, 1, 0, _THREAD),
        (_RETURN, 0, 0, _REFUSE),
        (_RETURN, 0, 0, _ALLOW),
        *(step for number in numbers for step in ((_EQUAL, 0, 1, number), (_RETURN, 0, 0, _REFUSE))),
        (_AT_LEAST, 0, 1, _OTHER_NUMBERS),
        (_RETURN, 0, 0, _REFUSE),
        (_RETURN, 0, 0, _ALLOW),
    )()


def sealed(*steps: tuple[int, int, int, int]) -> Callable[[], None]:
    """Returns what has the kernel run these steps, for good, at each system call of this process."""

    class Step(ctypes.Structure):
        _fields_ = [
            ("code", ctypes.c_uint16),
            ("yes", ctypes.c_uint8),
            ("no", ctypes.c_uint8),
            ("k", ctypes.c_uint32),
        ]

    class Program(ctypes.Structure):
        _fields_ = [("length", ctypes.c_ushort), ("steps", ctypes.POINTER(Step))]

    held = (Step * len(steps))(*(Step(*step) for step in steps))
    program = Program(len(held), held)
    control = ctypes.CDLL(None, use_errno=True).prctl
    control.argtypes = [ctypes.c_int, *[ctypes.c_ulong] * 4]

    def apply() -> None:
        if control(_NO_NEW_PRIVILEGES, 1, 0, 0, 0) or control(
            _SECCOMP, _FILTER, ctypes.addressof(program), 0, 0
        ):
            raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))

    return apply
