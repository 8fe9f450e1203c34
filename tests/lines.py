"""Lines that a running program writes, one by one."""

from __future__ import annotations

import os
import select
import subprocess
from typing import Any

from tests.waiting import until


def next_line(process: subprocess.Popen[Any]) -> str:
    """Wait for the next line of standard output, a pipe, and return it without its end; EOFError where none comes.

    No more than the line is taken: `communicate` finds the rest.
    """
    assert process.stdout is not None
    pipe = process.stdout.fileno()
    line = b""
    while not line.endswith(b"\n"):
        until(lambda: bool(select.select([pipe], [], [], 0)[0]), "a line of the program's output")
        byte = os.read(pipe, 1)
        if not byte:
            raise EOFError(f"the program's output ended with {line!r}")
        line += byte
    return line.decode().removesuffix("\n")
