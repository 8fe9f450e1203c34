"""Writing to standard output and standard error, which may be closed, full, or in another encoding.

What was asked for goes to standard output, and is an error if it cannot be written. Notices and measurements go to
standard error, and are dropped if they cannot.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from io import TextIOWrapper
from typing import TextIO

from minirt.errors import RenderError, printable


def prepare_streams() -> None:
    """Open the standard streams that the caller has closed, and let all of them write every character.

    An open stream keeps its number from the next file that is opened. Nothing can be written to it.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            with suppress(OSError):
                os.fstat(number)
                continue
            mode = "r" if name == "stdin" else "w"
            unwritable = os.open(os.devnull, os.O_RDONLY)
            setattr(sys, name, open(unwritable, mode, encoding="utf-8", closefd=False))  # noqa: SIM115
    if isinstance(sys.stdout, TextIOWrapper) and sys.stdout.errors == "strict":
        sys.stdout.reconfigure(errors="backslashreplace")  # as standard error does


def say(text: object, end: str = "\n") -> None:
    """Print to standard output, bytes as they are; RenderError when that fails."""
    try:
        if isinstance(text, bytes):
            sys.stdout.buffer.write(text)
        else:
            print(text, end=end)
        sys.stdout.flush()
    except OSError as error:
        mute(sys.stdout)
        if isinstance(error, BrokenPipeError):  # its reader knows
            raise
        raise RenderError(f"standard output: cannot write: {error.strerror or error}") from None


def tell(text: object, stream: TextIO | None = None) -> None:
    """Print lines to standard error, or to another stream, without control characters; do nothing when that fails."""
    stream = stream or sys.stderr
    try:
        print(*map(printable, str(text).split("\n")), sep="\n", file=stream, flush=True)
    except OSError:
        mute(stream)


def mute(stream: TextIO) -> None:
    """Discard what a stream still holds and will get, which Python would try to write at its end."""
    with suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
