"""Fences in a program that is started: OpenSCAD, which must read its fonts, and write one drawing.

    network namespace   as for programs in Python (`lock`)
    Landlock            Linux 5.13 and later: it may read the system's own folders, write in one folder, and
                        do nothing else to files
    system calls        Linux on x86-64 and ARM64: no sockets, no new processes (threads may be), no signals

Each is left out where the kernel does not have it.
"""

from __future__ import annotations

import ctypes
import os
import platform
import stat
from collections.abc import Mapping

from aidl_eval.sandbox import lock

_SYSTEM = (
    *("/usr", "/lib", "/lib64", "/bin", "/opt"),
    *("/etc/fonts", "/etc/ld.so.cache", "/var/cache/fontconfig"),
)
"""What programs and their libraries and fonts are read from."""

_CREATE, _ADD, _RESTRICT = 444, 445, 446
_NO_NEW_PRIVILEGES = 38
_EXECUTE, _WRITE, _READ, _LIST, _TRUNCATE, _IOCTL = 1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 14, 1 << 15
_OF_FILES = _EXECUTE | _WRITE | _READ | _TRUNCATE | _IOCTL
_RIGHTS: Mapping[int, int] = {1: (1 << 13) - 1, 2: (1 << 14) - 1, 3: (1 << 15) - 1, 5: (1 << 16) - 1}
"""By version of Landlock: all rights on files that it knows."""

_REFUSED: Mapping[str, tuple[int, ...]] = {
    "x86_64": (41, 53, 57, 58, 62, 101, 165, 200, 248, 250, 272, 298, 308, 310, 311, 321, 322, 323, 424, 425),
    "aarch64": (198, 199, 129, 117, 40, 130, 217, 219, 97, 241, 268, 270, 271, 280, 281, 282, 424, 425),
}
"""socket, socketpair, fork, vfork, kill, ptrace, mount, tkill, add_key, keyctl, unshare, perf_event_open,
setns, process_vm_readv, process_vm_writev, bpf, execveat, userfaultfd, pidfd_send_signal, io_uring_setup.
"""


def fence(folder: str) -> None:
    """Fences in this process and the program that it becomes; it may change files in one folder alone.

    Raises OSError if a layer that is there fails.
    """
    lock.leave_network()
    _fence_files(folder)
    if lock.has_filter():
        lock.refuse(_REFUSED[platform.machine()])


class _Ruleset(ctypes.Structure):
    _fields_ = [("files", ctypes.c_uint64)]


class _Beneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = [("allowed", ctypes.c_uint64), ("parent", ctypes.c_int32)]


def version() -> int:
    """Returns the version of Landlock; 0 where there is none."""
    if not lock.has_filter():
        return 0  # other processors have it by other numbers, other systems not at all
    return max(0, int(ctypes.CDLL(None).syscall(_CREATE, None, 0, 1)))


def _fence_files(folder: str) -> None:
    known = version()
    if not known:
        return
    rights = _RIGHTS[max(number for number in _RIGHTS if number <= known)]
    system = ctypes.CDLL(None, use_errno=True)
    of_all = _Ruleset(rights)
    rules = _done(system.syscall(_CREATE, ctypes.byref(of_all), ctypes.sizeof(of_all), 0))
    for path in _SYSTEM:
        if os.path.exists(path):
            _allow(system, rules, path, _EXECUTE | _READ | _LIST)
    _allow(system, rules, folder, rights & ~_EXECUTE)
    _done(system.prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0))
    _done(system.syscall(_RESTRICT, rules, 0))
    os.close(rules)


def _allow(system: ctypes.CDLL, rules: int, path: str, rights: int) -> None:
    place = os.open(path, os.O_PATH)
    try:
        is_folder = stat.S_ISDIR(os.fstat(place).st_mode)
        rule = _Beneath(rights if is_folder else rights & _OF_FILES, place)
        _done(system.syscall(_ADD, rules, 1, ctypes.byref(rule), 0))
    finally:
        os.close(place)


def _done(result: int) -> int:
    if result < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return result
