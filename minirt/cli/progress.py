"""Progress bar with the remaining time, on standard error if that is a terminal, for work of more than a second."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from time import perf_counter
from typing import TextIO

from minirt.helpers.progress import State, drawn

__all__ = ["State", "progress"]


@contextmanager
def progress(
    read: Callable[[], State], out: TextIO | None = None, clock: Callable[[], float] = perf_counter
) -> Iterator[None]:
    """Show the state that `read` returns while the block runs; another thread draws it."""
    stream = out or sys.stderr
    if not stream.isatty():
        yield
        return
    with drawn(read, partial(draw, stream), clock):
        yield


def draw(out: TextIO, text: str) -> None:
    """Replace the line of a terminal. One that has gone is no error."""
    with suppress(OSError, ValueError):  # ValueError: the stream is closed
        out.write("\r\x1b[K" + text[: shutil.get_terminal_size().columns - 1])
        out.flush()
