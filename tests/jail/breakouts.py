"""Acts by which a taken-over decoder would leave its confinement, and which parts of the confinement refuse them.

A process tries all of them in turn, with the whole confinement and with parts of it, as on systems that lack the rest.
"""

from __future__ import annotations

import sys
from collections.abc import Collection
from pathlib import Path
from typing import NamedTuple

from minirt.jail.messages import MEMORY
from tests.cli.program import environment
from tests.processes import run

NEVER = 99  # a version of Landlock that does not exist


class Act(NamedTuple):
    """An act, and what refuses it besides the filter of system calls, which refuses all but taking much memory."""

    source: str
    by_limits: bool = False
    by_limits_unless_root: bool = False
    landlock: int = NEVER  # the first version of Landlock that refuses it


OPENING = {"by_limits": True}
ACTS = {
    "read a file": Act("open(FILE).read()", landlock=1, **OPENING),
    "write a file": Act("open(FILE, 'w')", landlock=1, **OPENING),
    "list a folder": Act("os.listdir('/')", landlock=1, **OPENING),
    "open its own memory": Act("open('/proc/self/mem', 'r+b')", landlock=1, **OPENING),
    "open the parent's memory": Act("open(f'/proc/{PARENT}/mem', 'r+b')", landlock=1, **OPENING),
    "make a folder": Act("os.mkdir(FILE + ' of mine')", landlock=1),
    "truncate a file": Act("os.truncate(FILE, 0)", landlock=3),
    "change a mode": Act("os.chmod(FILE, 0o777)"),
    "delete a file": Act("os.unlink(FILE)", landlock=1),
    "make a socket": Act("socket.socket()", **OPENING),
    "make a datagram socket": Act("socket.socket(type=socket.SOCK_DGRAM)", **OPENING),
    "make a local socket": Act("socket.socket(socket.AF_UNIX)", **OPENING),
    "make a pair of sockets": Act("socket.socketpair()", **OPENING),
    "make a pipe": Act("os.pipe()", **OPENING),
    "make a file in memory": Act("os.memfd_create('x')", **OPENING),
    "copy a descriptor": Act("os.dup(1)", **OPENING),
    "use io_uring": Act("call(425, 8, ctypes.byref(ctypes.create_string_buffer(120)))", **OPENING),
    "take hold of the parent": Act("call(434, PARENT, 0)", **OPENING),
    "make a process": Act("os.fork() or os._exit(0)", by_limits_unless_root=True),
    "start a thread": Act("threading.Thread(target=int).start()", by_limits_unless_root=True),
    "send a signal": Act("os.kill(PARENT, 0)", landlock=6),
    "send a signal to a thread": Act("call(234, PARENT, PARENT, 0)", landlock=6),
    "trace the parent": Act("call(101, 0x4206, PARENT, 0, 0)", landlock=1),
    "write into the parent": Act("call(311, PARENT, *there, *there, 0)", landlock=1),
    "limit the parent": Act("resource.prlimit(PARENT, resource.RLIMIT_CORE, (0, 0))"),
    "make shared memory": Act("call(31, call(29, 0, 4096, 0o600), 0, 0)"),
    "wait for long": Act("call(35, ctypes.byref(ctypes.c_uint64()), 0)"),
    "take much memory": Act(f"bytes({MEMORY})", by_limits=True),
    "map much shared memory": Act(f"mmap.mmap(-1, {MEMORY})", by_limits=True),
    "raise a limit": Act("resource.setrlimit(resource.RLIMIT_NOFILE, (9, 9))", by_limits_unless_root=True),
    "run a program": Act("os.execv('/bin/sh', ['sh', '-c', 'echo done'])", landlock=1),
}
LEFT_TO_LIMITS = {"take much memory", "map much shared memory"}
# The buffer `mine` has the same address in the parent process, where only the child would write other bytes.
SOURCE = """
import ctypes, mmap, os, resource, signal, socket, sys, threading
from minirt.jail import confinement
FILE, PARENT = {file!r}, os.getpid()
library = ctypes.CDLL(None, use_errno=True)
library.syscall.restype = ctypes.c_long
mine = ctypes.create_string_buffer(b"good", 5)
class Vector(ctypes.Structure):
    _fields_ = (("start", ctypes.c_void_p), ("size", ctypes.c_size_t))
vector = Vector(ctypes.addressof(mine), 4)
there = (ctypes.byref(vector), 1)
def call(number, *arguments):
    whole = (ctypes.c_long(each) if isinstance(each, int) else each for each in arguments)
    result = library.syscall(ctypes.c_long(number), *whole)
    if result < 0:
        raise OSError(ctypes.get_errno(), "refused")
    return result
def attempt(name, source):
    print(name, end=": ", flush=True)
    try:
        exec(source, globals())
    except (OSError, MemoryError, RuntimeError, ValueError):
        print("refused", flush=True)
    else:
        print("done", flush=True)
child = os.fork()
if not child:
    mine[:4] = b"evil"
    {confine}
    for name, source in {acts!r}.items():
        attempt(name, source)
    os._exit(0)
os.waitpid(child, 0)
print("\\nwrite into the parent:", "done" if mine.value == b"evil" else "refused")
"""
PARTS = {
    "Landlock": "confinement.forbid_files = lambda library: None",
    "filter": "confinement.forbid_system_calls = lambda library: None",
}


def outcomes(folder: Path, without: Collection[str] | None, user: int | None = None) -> dict[str, str]:
    """Return what becomes of all acts in a process that is confined without some parts, or, for None, not at all.

    With a user, which root can become, the acts are those that limits refuse to all but root.
    """
    file = folder / "file"
    file.write_text("x")
    steps = ["pass"] if user is None else [f"os.setuid({user})"]
    if without is not None:
        steps += [*(PARTS[each] for each in without), "confinement.confine()"]
    acts = {name: act.source for name, act in ACTS.items() if user is None or act.by_limits_unless_root}
    source = SOURCE.format(file=str(file), confine="; ".join(steps), acts=acts)
    ended = run([sys.executable, "-c", source], env=environment() | {"PYTHONWARNINGS": "ignore"}, text=True)
    found = dict(line.split(": ", 1) for line in ended.stdout.splitlines() if line)
    return {name: found[name] or "refused" for name in acts}  # a program that cannot load its libraries says nothing


def landlock_version() -> int:
    """Return the version of Landlock of this system, 0 for none."""
    source = (
        "import ctypes\nlibrary = ctypes.CDLL(None)\n"
        "print(library.syscall(ctypes.c_long(444), None, ctypes.c_size_t(0), ctypes.c_uint(1)))"
    )
    return max(int(run([sys.executable, "-c", source], text=True).stdout), 0)
