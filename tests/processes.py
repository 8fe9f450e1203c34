"""Start programs in tests, each in its own process group, and fork.

A test that fails or is interrupted leaves nothing running: neither the program nor its child processes. A process that
hangs is ended by SIGABRT, and the error has the stacks of all its threads, written by Python's `faulthandler`.
"""

from __future__ import annotations

import faulthandler
import os
import select
import signal
import subprocess
import tempfile
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Timer
from typing import Any

from tests import waiting


@contextmanager
def started(command: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[Any]]:
    """Start a program. At the end of the block all processes of its group are killed.

    `options` are those of `subprocess.Popen`. A TimeoutError or subprocess.TimeoutExpired of the block gets a note with
    the stacks of the program, if its standard error is a pipe; otherwise the program writes them there.
    """
    environment = os.environ if options.get("env") is None else options["env"]
    options["env"] = {**environment, "PYTHONFAULTHANDLER": "1"}
    with subprocess.Popen(command, start_new_session=True, **options) as process:
        try:
            yield process
        except (TimeoutError, subprocess.TimeoutExpired) as hang:
            hang.add_note(stacks_of(process))
            raise
        finally:
            kill_group(process)


def kill_group(process: subprocess.Popen[Any], number: int = signal.SIGKILL) -> None:
    """Kill a program and its child processes, or send them another signal."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, number)


def stacks_of(process: subprocess.Popen[Any]) -> str:
    """Abort a program that hangs, and return what it has written to standard error, its stacks at the end."""
    kill_group(process, signal.SIGABRT)
    with suppress(subprocess.TimeoutExpired):  # a stopped program does not end
        process.wait(waiting.HANG_LIMIT)
    kill_group(process)
    with suppress(subprocess.TimeoutExpired, ValueError):  # a child that left the group holds it open; it was closed
        _, told = process.communicate(timeout=waiting.HANG_LIMIT)
        return told.decode(errors="replace") if isinstance(told, bytes) else told or ""
    return ""


def run(command: Sequence[str], given: Any = None, **options: Any) -> subprocess.CompletedProcess[Any]:
    """Run a program to its end and return its output. subprocess.TimeoutExpired after `HANG_LIMIT`.

    `given` is its standard input; `options` are those of `subprocess.Popen`; `text=True` makes input and output texts.
    """
    options |= {"stdin": subprocess.PIPE} if given is not None else {}
    with started(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options) as process:
        out, err = process.communicate(given, timeout=waiting.HANG_LIMIT)
    return subprocess.CompletedProcess(command, process.returncode, out, err)


def next_line(process: subprocess.Popen[Any], errors: bool = False) -> str:
    """Wait for the next line of standard output, or of standard error, and return it without its line end.

    Only the line is read from the pipe: `communicate` returns the rest. EOFError at the end; TimeoutError after
    `HANG_LIMIT`, while `readline` would wait for ever.
    """
    stream = process.stderr if errors else process.stdout
    assert stream is not None
    pipe = stream.fileno()
    line = b""
    while not line.endswith(b"\n"):
        waiting.until(lambda: bool(select.select([pipe], [], [], 0)[0]), "a line of the program's output")
        byte = os.read(pipe, 1)
        if not byte:
            raise EOFError(f"the program's output ended with {line!r}")
        line += byte
    return line.decode().removesuffix("\n")


def fork(work: Callable[[], object]) -> Callable[[], int]:
    """Do work in a child process, by `os.fork()`. Return a function that waits for its end and returns its exit status.

    That is 0, or 1 after an error, or the negative number of the signal that killed it. After `HANG_LIMIT` the child is
    ended, and a TimeoutError has its stacks.
    """
    stacks = tempfile.TemporaryFile()  # noqa: SIM115  (closed by `wait`)
    child = os.fork()
    if not child:
        status = 1
        try:
            faulthandler.enable(stacks)
            work()
            status = 0
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(status)

    def wait() -> int:
        hang = Timer(waiting.HANG_LIMIT, os.kill, (child, signal.SIGABRT))
        hang.daemon = True
        hang.start()
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        hang.cancel()
        hang.join()  # else the next fork would be one of several threads
        with stacks:
            stacks.seek(0)
            if status == -signal.SIGABRT:
                raise TimeoutError(f"a child process hung or was aborted: {stacks.read().decode(errors='replace')}")
        return status

    return wait


def in_child(work: Callable[[], object]) -> int:
    """Do work in a child process, wait for its end and return its exit status: see `fork`."""
    return fork(work)()


def until_stopped(process: subprocess.Popen[Any]) -> bool:
    """Wait until SIGSTOP has stopped a program; False where it had ended with status 0 before."""
    found: list[int] = []

    def look() -> bool:
        pid, status = os.waitpid(process.pid, os.WUNTRACED | os.WNOHANG)
        found.append(status)
        return pid != 0

    waiting.until(look, "the stop of a program")
    assert os.WIFSTOPPED(found[-1]) or os.waitstatus_to_exitcode(found[-1]) == 0
    return os.WIFSTOPPED(found[-1])


def is_running(process: int) -> bool:
    """Whether a process has not ended, on Linux."""
    try:
        status = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False
    return status.rpartition(")")[2].split()[0] not in "ZX"
