"""Confinement of the helper process: it computes, reads its input and writes its output, and can do nothing else.

Resource limits hold on all systems but Windows: on memory, time and descriptors. On Linux, Landlock takes the file
system, TCP, signals and other processes' memory away, and seccomp all system calls but those that computing needs, by a
filter for x86-64. Nothing of this can be undone.
"""

from __future__ import annotations

import ctypes
import os
import sys
from contextlib import suppress

from minirt.jail.messages import CPU_TIME, MEMORY

if sys.platform != "win32":
    import resource

SIGNAL_AT_END_OF_PARENT, NO_NEW_PRIVILEGES, SECCOMP, SECCOMP_FILTER = 1, 38, 22, 2  # of prctl
KILL_SIGNAL = 9  # without `signal`, which takes 2 ms to import
CREATE_RULESET, RESTRICT_SELF = 444, 446  # numbers of system calls, the same on all processors
VERSION = 1  # the flag that asks for the version of Landlock
FILES = {1: 13, 2: 14, 3: 15, 5: 16}  # version of Landlock -> number of its rights to files
TCP, SCOPES = 4, 6  # versions that know the two rights to TCP ports, and the scopes of sockets and signals

X86_64 = 0xC000003E  # AUDIT_ARCH_X86_64
LOAD, JUMP_IF_EQUAL, RETURN = 0x20, 0x15, 0x06  # instructions of the filter
NUMBER_AT, PROCESSOR_AT = 0, 4  # bytes in struct seccomp_data
ALLOW, REFUSE, KILL = 0x7FFF0000, 0x00050000 | 1, 0x80000000  # what a filter returns; refused with EPERM
CALLS = (
    *(0, 1, 3, 5, 8),  # read, write, close, fstat, lseek
    *(9, 10, 11, 12, 25, 28),  # mmap, mprotect, munmap, brk, mremap, madvise
    *(13, 14, 15),  # rt_sigaction, rt_sigprocmask, rt_sigreturn
    *(24, 202, 228, 318),  # sched_yield, futex, clock_gettime, getrandom
    *(60, 231),  # exit, exit_group
)


class Instruction(ctypes.Structure):
    """struct sock_filter: an instruction of a filter."""

    _fields_ = (("code", ctypes.c_ushort), ("yes", ctypes.c_ubyte), ("no", ctypes.c_ubyte), ("value", ctypes.c_uint))


class Program(ctypes.Structure):
    """struct sock_fprog: the instructions of a filter."""

    _fields_ = (("length", ctypes.c_ushort), ("instructions", ctypes.POINTER(Instruction)))


def confine() -> None:
    """Confine this process as far as the system can; what it cannot is left out."""
    if sys.platform == "win32":
        return
    limit(resource.RLIMIT_AS, MEMORY, MEMORY)
    limit(resource.RLIMIT_CPU, CPU_TIME, CPU_TIME + 1)  # the first ends it with SIGXCPU, the second with SIGKILL
    limit(resource.RLIMIT_CORE, 0, 0)
    limit(resource.RLIMIT_FSIZE, 0, 0)
    limit(resource.RLIMIT_NPROC, 0, 0)  # no processes and threads, unless root runs this one
    if sys.platform == "linux":
        library = ctypes.CDLL(None)
        library.syscall.restype = ctypes.c_long
        library.prctl(SIGNAL_AT_END_OF_PARENT, ctypes.c_ulong(KILL_SIGNAL))
        library.prctl(NO_NEW_PRIVILEGES, *map(ctypes.c_ulong, (1, 0, 0, 0)))
        forbid_files(library)
        forbid_descriptors()  # Landlock needs one
        if os.uname().machine == "x86_64" and sys.maxsize > 2**32:
            forbid_system_calls(library)
    else:
        forbid_descriptors()


def forbid_descriptors() -> None:
    """Forbid to open anything: files, pipes, sockets, memory of other processes and rings of io_uring."""
    limit(resource.RLIMIT_NOFILE, 0, 0)


def limit(what: int, soft: int, hard: int) -> None:
    """Lower a resource limit of this process."""
    _, most = resource.getrlimit(what)
    if most != resource.RLIM_INFINITY:
        soft, hard = min(soft, most), min(hard, most)
    with suppress(OSError, ValueError):
        resource.setrlimit(what, (soft, hard))


def forbid_files(library: ctypes.CDLL) -> None:
    """Forbid, by Landlock, to open files, to use TCP, and to reach other processes."""
    version = library.syscall(ctypes.c_long(CREATE_RULESET), None, ctypes.c_size_t(0), ctypes.c_uint(VERSION))
    if version < 1:
        return
    files = (1 << FILES[max(each for each in FILES if each <= version)]) - 1
    rights = [files, *[0b11] * (version >= TCP), *[0b11] * (version >= SCOPES)]
    handled = (ctypes.c_uint64 * len(rights))(*rights)  # struct landlock_ruleset_attr
    size = ctypes.c_size_t(ctypes.sizeof(handled))
    ruleset = library.syscall(ctypes.c_long(CREATE_RULESET), ctypes.byref(handled), size, ctypes.c_uint(0))
    if ruleset >= 0:  # no rule allows anything
        library.syscall(ctypes.c_long(RESTRICT_SELF), ctypes.c_int(ruleset), ctypes.c_uint(0))
        os.close(ruleset)


def forbid_system_calls(library: ctypes.CDLL) -> None:
    """Refuse, by seccomp, all system calls but `CALLS`."""
    steps = [
        (LOAD, 0, 0, PROCESSOR_AT),
        (JUMP_IF_EQUAL, 1, 0, X86_64),
        (RETURN, 0, 0, KILL),
        (LOAD, 0, 0, NUMBER_AT),
        *((JUMP_IF_EQUAL, len(CALLS) - at, 0, number) for at, number in enumerate(CALLS)),
        (RETURN, 0, 0, REFUSE),
        (RETURN, 0, 0, ALLOW),
    ]
    instructions = (Instruction * len(steps))(*(Instruction(*step) for step in steps))
    program = Program(len(steps), instructions)
    library.prctl(SECCOMP, ctypes.c_ulong(SECCOMP_FILTER), ctypes.byref(program))
