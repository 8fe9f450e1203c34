"""Work in a child process of which one operation on files fails, or at which it is killed."""

from __future__ import annotations

import errno
import gc
import os
import resource
import select
import signal
import socket
import sys
import tempfile
import threading
import traceback
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import IO, NamedTuple, NoReturn

from tests.faults.calls import Call, answer, listen, receive
from tests.waiting import HANG_LIMIT

KILL, SHORT, STICKY = "kill", "short", "+"
ERRORS = "EIO", "ENOSPC", "EACCES"
KINDS = (*ERRORS, *(name + STICKY for name in ERRORS), SHORT, KILL)
CRASHED = 99  # exit status after an exception


class Fault(NamedTuple):
    """Fault of an operation: the name of an error, which with + all that follow have, too; a write of half of
    the bytes, after which the disk is full; or the end of the process."""

    number: int  # from 1
    kind: str


class Ended(NamedTuple):
    """The end of some work."""

    status: int  # or the negative number of a signal
    output: str  # standard output and standard error
    operations: list[str]  # names of the operations on files of the folder


def run(work: Callable[[], int], folder: Path, fault: Fault | None = None) -> Ended:
    """Do work, which returns an exit status, in a child process in a folder, with a fault of an operation on the files
    there. OSError where the system does not allow that; TimeoutError where the work hangs."""
    mine, others = socket.socketpair()
    with tempfile.TemporaryFile() as output, mine:
        child = os.fork()
        if not child:
            in_child(work, folder, output, others)
        others.close()
        _, descriptors, _, _ = socket.recv_fds(mine, 1, 1)
        if not descriptors:
            os.waitpid(child, 0)
            output.seek(0)
            raise OSError(output.read().decode().strip().rpartition("\n")[2])
        try:
            operations = supervise(child, descriptors[0], str(folder), fault)
        finally:
            os.close(descriptors[0])
            with suppress(ProcessLookupError):  # it has ended, and was not waited for
                os.kill(child, signal.SIGKILL)
            status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        output.seek(0)
        return Ended(status, output.read().decode(errors="replace"), operations)


def in_child(work: Callable[[], int], folder: Path, output: IO[bytes], others: socket.socket) -> NoReturn:
    """Do the work, and end the process with its exit status."""
    status = CRASHED
    try:
        gc.disable()  # nothing of the parent process is closed here
        for number in (1, 2):
            os.dup2(output.fileno(), number)
        sys.stdout, sys.stderr = (os.fdopen(number, "w", encoding="utf-8", closefd=False) for number in (1, 2))
        sys.unraisablehook, threading.excepthook = sys.__unraisablehook__, threading.__excepthook__
        warnings.simplefilter("error")
        os.chdir(folder)
        listener = listen()
        socket.send_fds(others, [b"\0"], [listener])
        os.close(listener)
        status = work()
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else CRASHED
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def supervise(child: int, listener: int, folder: str, fault: Fault | None) -> list[str]:
    """Answer the calls of a process until it ends; return the names of those that are about files of the folder."""
    operations: list[str] = []
    unlimited = resource.prlimit(child, resource.RLIMIT_FSIZE)
    poll = select.poll()
    poll.register(listener, select.POLLIN)
    is_limited = False
    while True:
        events = poll.poll(1000 * HANG_LIMIT)
        if not events:
            raise TimeoutError(f"after {operations[-3:]} it did not end within {HANG_LIMIT:.0f} s")
        if not events[0][1] & select.POLLIN:
            return operations
        with suppress(FileNotFoundError, ProcessLookupError):  # the process has ended
            if is_limited:
                resource.prlimit(child, resource.RLIMIT_FSIZE, unlimited)
                is_limited = False
            call = receive(listener)
            error = 0
            if any(path == folder or path.startswith(f"{folder}/") for path in call.paths):
                operations.append(call.name)
                number = len(operations)
                if fault and (number == fault.number or (number > fault.number and fault.kind.endswith(STICKY))):
                    if fault.kind == KILL:
                        os.kill(child, signal.SIGKILL)
                        return operations
                    if fault.kind != SHORT:
                        error = getattr(errno, fault.kind.removesuffix(STICKY))
                    elif call.name == "write":
                        half = position(call) + call.arguments[2] // 2
                        resource.prlimit(child, resource.RLIMIT_FSIZE, (half, unlimited[1]))
                        is_limited = True
            answer(listener, call, error)


def position(call: Call) -> int:
    """Return the place in a file where a write begins, in bytes."""
    lines = Path(f"/proc/{call.thread}/fdinfo/{call.arguments[0]}").read_text(encoding="ascii").splitlines()
    return int(lines[0].removeprefix("pos:"))
