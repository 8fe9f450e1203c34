"""The progress bar is drawn on terminals alone, after a second, with the time that is left, and erased at the end."""

from __future__ import annotations

import io
import signal
from functools import partial
from threading import Event

import pytest

from minirt.helpers import progress as module
from minirt.helpers.progress import WorkState, draw, draw_until, line, progress
from tests.waiting import HANG_LIMIT


class Terminal(io.StringIO):
    """A terminal that keeps what is written."""

    def isatty(self) -> bool:
        return True


class Ended(Event):
    """An end that comes after some waits, and keeps their lengths."""

    def __init__(self, waits: int) -> None:
        self.left, self.waited = waits, []  # type: ignore[var-annotated]

    def wait(self, timeout: float | None = None) -> bool:
        self.waited.append(timeout)
        self.left -= 1
        return self.left < 0


@pytest.mark.parametrize(
    ("state", "seconds", "text"),
    [
        (WorkState("x.png", 0.25), 10, "######------------------  25%  30 s left  x.png"),
        (WorkState("x.png", 1.0), 10, "######################## 100%  0 s left  x.png"),
        (WorkState("x.png", 1.5), 10, "######################## 100%  0 s left  x.png"),
        (WorkState("film", 0.01), 100, "------------------------   1%  2 h 45 min left  film"),
        (WorkState("reading"), 12.4, "12 s  reading"),
        (WorkState("x.png", 0.0), 12.4, "12 s  x.png"),
    ],
)
def test_the_bar_tells_share_and_remaining_time(state: WorkState, seconds: float, text: str) -> None:
    assert line(state, seconds) == text


def test_the_first_second_has_no_bar_and_the_end_erases_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "perf_counter", iter([0.0, 1.0, 1.2, 1.2]).__next__)
    out, ended = Terminal(), Ended(2)
    draw_until(ended, lambda: WorkState("x", 0.5), partial(draw, out))
    assert ended.waited == [module.PATIENCE, module.PAUSE, module.PAUSE]
    first, second, last = out.getvalue().split("\r\x1b[K")[1:]
    assert (first, second, last) == (line(WorkState("x", 0.5), 1.0), line(WorkState("x", 0.5), 1.2), "")
    quick = Terminal()
    draw_until(Ended(0), lambda: WorkState("x", 0.5), partial(draw, quick))
    assert quick.getvalue() == ""


def test_the_time_in_which_a_program_was_stopped_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "perf_counter", iter([0.0, 1.0, 3601.0, 3601.2]).__next__)
    out = Terminal()
    draw_until(Ended(3), lambda: WorkState("x", 0.5), partial(draw, out))
    shown = out.getvalue().split("\r\x1b[K")[1:]
    assert shown == [*(line(WorkState("x", 0.5), seconds) for seconds in (1.0, 1.0 + module.PAUSE, 1.4)), ""]


def test_without_a_terminal_nothing_is_asked_and_nothing_written() -> None:
    def never() -> WorkState:
        raise AssertionError

    out = io.StringIO()
    with progress(never, out):
        pass
    assert out.getvalue() == ""


def test_a_terminal_that_has_gone_is_no_error() -> None:
    gone = Terminal()
    gone.close()
    draw_until(Ended(3), lambda: WorkState("x"), partial(draw, gone))


def test_the_block_ends_the_thread_also_by_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    drawn, out = Event(), Terminal()

    def state() -> WorkState:
        assert signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])  # the main thread gets Ctrl+C
        drawn.set()
        return WorkState("x")

    def interrupted() -> None:
        with progress(state, out):
            assert drawn.wait(HANG_LIMIT)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert out.getvalue().endswith("\r\x1b[K")
