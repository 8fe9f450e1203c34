"""System calls on files: their numbers, the paths that they name, and their way to a supervisor.

A filter of the kernel (seccomp, with user notification) stops each such call of a process, whichever library makes it,
until another process has answered: do it, or fail with an error number. It needs Linux 5.9 on x86-64, and no compiler.
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import struct
import sys
from pathlib import Path
from typing import NamedTuple

# What the arguments are: `p` a path, `d` the folder of the path that follows, `f` a file, `-` something else.
CALLS: dict[int, tuple[str, str]] = {
    **{number: (name, "p") for number, name in {
        2: "open", 4: "stat", 6: "lstat", 21: "access", 76: "truncate", 83: "mkdir", 84: "rmdir", 87: "unlink",
        89: "readlink", 90: "chmod", 92: "chown", 94: "lchown", 188: "setxattr", 191: "getxattr", 194: "listxattr",
    }.items()},
    **{number: (name, "f") for number, name in {
        0: "read", 1: "write", 3: "close", 5: "fstat", 17: "pread", 18: "pwrite", 19: "readv", 20: "writev",
        73: "flock", 74: "fsync", 75: "fdatasync", 77: "ftruncate", 91: "fchmod", 93: "fchown", 217: "getdents",
        285: "fallocate",
    }.items()},
    **{number: (name, "dp") for number, name in {
        257: "openat", 258: "mkdirat", 260: "fchownat", 262: "newfstatat", 263: "unlinkat", 267: "readlinkat",
        268: "fchmodat", 269: "faccessat", 280: "utimensat", 332: "statx", 439: "faccessat2", 452: "fchmodat2",
    }.items()},
    9: ("mmap", "----f"), 40: ("sendfile", "ff"), 326: ("copy_file_range", "f-f"),
    82: ("rename", "pp"), 86: ("link", "pp"), 88: ("symlink", "-p"),
    264: ("renameat", "dpdp"), 265: ("linkat", "dpdp"), 266: ("symlinkat", "-dp"), 316: ("renameat2", "dpdp"),
}  # fmt: skip
SECCOMP, SET_FILTER, NEW_LISTENER = 317, 1, 8
NO_NEW_PRIVILEGES = 38  # of prctl
LOAD_NUMBER, IS_EQUAL, RETURN = 0x20, 0x15, 0x06  # instructions of the filter
ALLOW, NOTIFY = 0x7FFF0000, 0x7FC00000
RECEIVE, SEND, ADD_FILE = 0xC0502100, 0xC0182101, 0x40182103  # operations on the listener
NOTE, ANSWER, ADDED = struct.Struct("<QIIiIQ6Q"), struct.Struct("<QqiI"), struct.Struct("<QIIII")
GO_ON, REPLACE = 1, 1  # flags of an answer and of an added file
PAGE, LONGEST_PATH = 4096, 4096
UNUSABLE = "" if sys.platform == "linux" and os.uname().machine == "x86_64" else "needs Linux on x86-64"


class Call(NamedTuple):
    """A call that waits for an answer."""

    id: int
    thread: int
    name: str
    arguments: tuple[int, ...]
    paths: list[str]  # of the files that it is about


def listen() -> int:
    """Have all further calls on files of this process stopped, and return the descriptor of their listener. OSError."""
    numbers = sorted(CALLS)
    steps = [(LOAD_NUMBER, 0, 0, 0)]
    steps += [(IS_EQUAL, len(numbers) - place, 0, number) for place, number in enumerate(numbers)]
    steps += [(RETURN, 0, 0, ALLOW), (RETURN, 0, 0, NOTIFY)]
    code = ctypes.create_string_buffer(b"".join(struct.pack("<HBBI", *step) for step in steps))
    program = struct.pack("<HxxxxxxQ", len(steps), ctypes.addressof(code))
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    listener: int = libc.syscall(SECCOMP, SET_FILTER, NEW_LISTENER, ctypes.c_char_p(program))
    if listener < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return listener


def receive(listener: int) -> Call:
    """Return the next call. FileNotFoundError where its process has ended meanwhile."""
    note = bytearray(NOTE.size)
    fcntl.ioctl(listener, RECEIVE, note)
    number, thread, _, call, _, _, *arguments = NOTE.unpack(note)
    name, kinds = CALLS[call]
    try:
        return Call(number, thread, name, tuple(arguments), paths_of(thread, kinds, arguments))
    except ProcessLookupError:
        raise FileNotFoundError from None


def answer(listener: int, call: Call, error: int = 0) -> None:
    """Let a call be done, or fail with an error number. FileNotFoundError where its process has ended meanwhile.

    A file is closed even where closing fails, as on Linux.
    """
    if error and call.name == "close":
        with Path(os.devnull).open("rb") as other:
            added = ADDED.pack(call.id, REPLACE, other.fileno(), call.arguments[0], os.O_CLOEXEC)
            fcntl.ioctl(listener, ADD_FILE, bytearray(added))
    fcntl.ioctl(listener, SEND, bytearray(ANSWER.pack(call.id, 0, -error, 0 if error else GO_ON)))


def paths_of(thread: int, kinds: str, arguments: list[int]) -> list[str]:
    """Return the paths of the files that a call of a thread is about."""
    found, folder = [], f"/proc/{thread}/cwd"
    for kind, value in zip(kinds, arguments, strict=False):
        descriptor = ctypes.c_int(value).value
        link = f"/proc/{thread}/fd/{descriptor}" if descriptor >= 0 else f"/proc/{thread}/cwd"
        if kind == "d":
            folder = link
        elif kind == "p":
            found.append(os.path.normpath(os.path.join(target_of(folder), text_at(thread, value))))  # noqa: PTH118
        elif kind == "f" and descriptor >= 0:
            found.append(target_of(link))
    return found


def target_of(link: str) -> str:
    """Return what a link of /proc leads to; nothing for a descriptor that is not open."""
    try:
        return str(Path(link).readlink())
    except FileNotFoundError:
        return ""


def text_at(thread: int, address: int) -> str:
    """Return the text at an address in the memory of a thread's process; nothing where there is none."""
    data = b""
    if address:
        with Path(f"/proc/{thread}/mem").open("rb", buffering=0) as memory:
            while b"\0" not in data and len(data) < LONGEST_PATH:
                memory.seek(address + len(data))
                try:
                    data += memory.read(PAGE - (address + len(data)) % PAGE)
                except OSError:
                    break
    return os.fsdecode(data.partition(b"\0")[0])
