"""The progress bar is shown on terminals only."""

from __future__ import annotations

import io
import sys

import pytest

from minirt.report.progress import progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_terminal_shows_how_far_it_is_and_is_left_clean(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    with progress(4) as shown:
        for what in ("one", "two", "three"):
            shown.step(what)
    start, one, two, three, end = terminal.getvalue().split("\r\x1b[K")
    assert (start, end) == ("", "")
    assert one == "-" * 24 + "   0% one"
    assert two == "#" * 6 + "-" * 18 + "  25% two"
    assert three.endswith(" 50% three")


def test_the_terminal_is_left_clean_after_an_interrupt(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())

    def interrupted() -> None:
        with progress(2) as shown:
            shown.step("one")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert terminal.getvalue().endswith("\r\x1b[K")


def test_a_file_gets_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", file := io.StringIO())
    with progress(2) as shown:
        shown.step("one")
    assert file.getvalue() == ""
