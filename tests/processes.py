"""Start programs in tests, each in its own process group.

A test that fails or is interrupted leaves nothing running: neither the program nor its child processes.
"""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from tests.waiting import HANG_LIMIT


@contextmanager
def started(command: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[Any]]:
    """Start a program. At the end of the block all processes of its group are killed.

    `options` are those of `subprocess.Popen`.
    """
    with subprocess.Popen(command, start_new_session=True, **options) as process:
        try:
            yield process
        finally:
            kill_group(process)


def kill_group(process: subprocess.Popen[Any]) -> None:
    """Kill a program and its child processes."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def run(command: Sequence[str], **options: Any) -> subprocess.CompletedProcess[Any]:
    """Run a program to its end and return its output. subprocess.TimeoutExpired after `HANG_LIMIT`.

    `options` are those of `subprocess.Popen`; `text=True` decodes standard output and standard error.
    """
    with started(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options) as process:
        out, err = process.communicate(timeout=HANG_LIMIT)
    return subprocess.CompletedProcess(command, process.returncode, out, err)


def is_running(process: int) -> bool:
    """Whether a process has not ended, on Linux."""
    try:
        status = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False
    return status.rpartition(")")[2].split()[0] not in "ZX"
