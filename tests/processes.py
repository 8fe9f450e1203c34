"""Programs that tests start. Each has a process group of its own, so that a test which fails or is interrupted leaves
nothing running: neither the program nor what the program started."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from tests.waiting import HANG_LIMIT


@contextmanager
def started(command: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[Any]]:
    """A running program; when the block ends, whatever of its process group still runs is killed.

    `options` are those of `subprocess.Popen`.
    """
    with subprocess.Popen(command, start_new_session=True, **options) as process:
        try:
            yield process
        finally:
            kill_group(process)


def kill_group(process: subprocess.Popen[Any]) -> None:
    """Kill the program and all that it started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def run(command: Sequence[str], **options: Any) -> subprocess.CompletedProcess[Any]:
    """Run a program to its end, with what it wrote; subprocess.TimeoutExpired after `HANG_LIMIT`.

    `options` are those of `subprocess.Popen`; `text=True` decodes standard output and standard error.
    """
    with started(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options) as process:
        out, err = process.communicate(timeout=HANG_LIMIT)
    return subprocess.CompletedProcess(command, process.returncode, out, err)
