"""Read the output of a running program line by line."""

from __future__ import annotations

import os
import select
import subprocess
from typing import Any

from tests.waiting import until


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
        until(lambda: bool(select.select([pipe], [], [], 0)[0]), "a line of the program's output")
        byte = os.read(pipe, 1)
        if not byte:
            raise EOFError(f"the program's output ended with {line!r}")
        line += byte
    return line.decode().removesuffix("\n")
