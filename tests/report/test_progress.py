"""The progress bar and its remaining time are shown on terminals only."""

from __future__ import annotations

import io
import sys

import pytest

from minirt.report.progress import in_words, progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


class Clock:
    """A clock that the test moves on."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


def bars(terminal: Terminal) -> list[str]:
    """Return what the line has shown, one after the other."""
    return terminal.getvalue().split("\r\x1b[K")


def test_a_terminal_shows_how_far_it_is_and_is_left_clean(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    with progress(clock := Clock()) as shown:
        shown.step("compiling")
        clock.now = 100.0  # which nobody has expected
        shown.expect((what, 10.0) for what in ("one", "two", "three", "four"))
        for what in ("one", "two", "three"):
            shown.step(what)
            clock.now += 10.0
    start, compiling, one, two, three, end = bars(terminal)
    assert (start, end) == ("", "")
    assert compiling == "-" * 24 + "   0%  compiling"
    assert one == "-" * 24 + "   0%  40 s left  one"
    assert two == "#" * 6 + "-" * 18 + "  25%  30 s left  two"
    assert three == "#" * 12 + "-" * 12 + "  50%  20 s left  three"


def test_the_remaining_time_follows_the_pace(monkeypatch: pytest.MonkeyPatch) -> None:
    """Everything takes three times as long as expected: after half of it, nearly as long remains as has gone by."""
    monkeypatch.setattr(sys, "stderr", Terminal())
    with progress(clock := Clock()) as shown:
        shown.expect([("step", 100.0)] * 10)
        remaining = []
        for _ in range(10):
            shown.step("step")
            remaining.append(shown.remaining())
            clock.now += 300.0
    assert remaining[0] == pytest.approx(1000.0)
    assert remaining[5] == pytest.approx(500 * 3, rel=0.1)
    assert remaining[1:] == sorted(remaining[1:], reverse=True)


def test_more_steps_than_expected_do_not_go_beyond_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    with progress(Clock()) as shown:
        shown.expect([("step", 10.0)])
        for _ in range(3):
            shown.step("step")
    assert bars(terminal)[3] == "#" * 24 + " 100%  0 s left  step"


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.4, "0 s"), (89, "89 s"), (100, "2 min"), (3600, "60 min"), (7500, "2 h 5 min")]
)
def test_a_time_is_told_in_its_unit(seconds: float, words: str) -> None:
    assert in_words(seconds) == words


def test_the_terminal_is_left_clean_after_an_interrupt(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())

    def interrupted() -> None:
        with progress() as shown:
            shown.step("one")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert terminal.getvalue().endswith("\r\x1b[K")


def test_a_file_gets_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", file := io.StringIO())
    with progress() as shown:
        shown.step("one")
    assert file.getvalue() == ""
