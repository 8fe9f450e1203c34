"""Progress of work that takes more than a second: its line of text, the thread that draws it, and notebooks.

A terminal shows a bar on standard error, a notebook below the cell; both take it away at the end.
"""

from __future__ import annotations

import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar, copy_context
from functools import partial
from itertools import chain, repeat
from threading import Event, Thread
from time import perf_counter
from typing import NamedTuple, TextIO

from minirt.errors import printable

PATIENCE = 1.0  # seconds of work without a bar
PAUSE = 0.2  # seconds from one drawing of the bar to the next
STOPPED = 30.0  # seconds between two drawings in which the program was stopped, as by Ctrl+Z, and did not work
BAR = 24  # characters
SHOWN: ContextVar[bool] = ContextVar("shown", default=False)  # whether a bar for this work is in the notebook


class WorkState(NamedTuple):
    """Share of some work that is done."""

    what: str
    share: float | None = None  # of the whole, from 0 to 1; None while nobody knows


@contextmanager
def drawn(read: Callable[[], WorkState], draw: Callable[[str], object]) -> Iterator[None]:
    """Draw the state that `read` returns while the block runs, from another thread, by `draw(text)`.

    Nothing is drawn in the first second, or where the system allows no more threads. `draw("")` erases what was drawn,
    at the end. The thread sees the context variables of the caller.
    """
    ended = Event()

    def run() -> None:
        if hasattr(signal, "pthread_sigmask"):  # the main thread, which waits for a picture, is to get all signals
            signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
        draw_until(ended, read, draw)

    thread = Thread(target=copy_context().run, args=(run,), daemon=True)
    with suppress(RuntimeError):  # the system allows no more threads
        thread.start()
    try:
        yield
    finally:
        ended.set()
        if thread.ident is not None:
            thread.join()


def draw_until(ended: Event, read: Callable[[], WorkState], draw: Callable[[str], object]) -> None:
    """Draw the bar until the work has ended, then erase it."""
    last, seconds, pause, is_drawn = perf_counter(), 0.0, PATIENCE, False
    while not ended.wait(pause):
        last, passed = (now := perf_counter()), now - last
        seconds += passed if passed < STOPPED else pause
        draw(line(read(), seconds))
        pause, is_drawn = PAUSE, True
    if is_drawn:
        draw("")


def line(state: WorkState, seconds: float) -> str:
    """Return the bar: how much is done, and the time that is left if the rest is as fast, or that has passed."""
    if not state.share:
        return f"{in_words(seconds)}  {state.what}"
    share = min(state.share, 1.0)
    left = in_words(seconds * (1 - share) / share)
    return f"{'#' * round(BAR * share):-<{BAR}} {share:4.0%}  {left} left  {state.what}"


def in_words(seconds: float) -> str:
    """Say a time in the unit that people would use."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


def in_notebook() -> bool:
    """Whether the program runs in the kernel of a notebook."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return hasattr(shell, "kernel")


@contextmanager
def in_notebooks(read: Callable[[], WorkState]) -> Iterator[None]:
    """Show the state that `read` returns below the cell while the block runs, and not that of the parts of this work
    beside it; elsewhere do nothing."""
    if SHOWN.get() or not in_notebook():
        yield
        return
    token = SHOWN.set(True)
    try:
        with drawn(read, notebook_line()):
            yield
    finally:
        SHOWN.reset(token)


def notebook_line() -> Callable[[str], None]:
    """Return a function that shows a text below a cell, in place of its last one; none erases that."""
    from IPython.display import DisplayHandle

    line = DisplayHandle()
    show = chain([line.display], repeat(line.update))

    def draw(text: str) -> None:
        next(show)({"text/plain": text} if text else {"text/html": ""}, raw=True)

    return draw


@contextmanager
def progress(read: Callable[[], WorkState], out: TextIO | None = None) -> Iterator[None]:
    """Show the state that `read` returns while the block runs, on standard error if that is a terminal."""
    stream = out or sys.stderr
    if not stream.isatty():
        yield
        return
    with drawn(read, partial(draw, stream)):
        yield


def draw(out: TextIO, text: str) -> None:
    """Replace the line of a terminal. One that has gone is no error."""
    with suppress(OSError, ValueError):  # ValueError: the stream is closed
        out.write("\r\x1b[K" + printable(text)[: shutil.get_terminal_size().columns - 1])
        out.flush()
