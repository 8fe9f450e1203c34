"""The program in a real window while another process compiles its kernel."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from tests.viewer.test_real_window import SIZE, TEXT, Viewer, picture, viewing
from tests.windows import Desktop, until

pytestmark = pytest.mark.window


@pytest.fixture
def compiling(desktop: Desktop, tmp_path: Path) -> Iterator[Viewer]:
    """The first run of the program, from the moment when it shows something; afterwards no compiler is left."""
    with viewing(desktop, tmp_path / "first.rt", cache=tmp_path / "cache") as opened:
        until(lambda: desktop.screenshot(opened.window).any(), "words in the black window")
        compilers = children(opened.process.pid)
        assert len(compilers) == 1
        yield opened
        until(lambda: not any(map(runs, compilers)), "the end of the compiler", 0.5)


def children(program: int) -> list[int]:
    """The processes that a process has started."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if int(stat(int(folder.name))[1]) == program:
                found.append(int(folder.name))
    return found


def runs(process: int) -> bool:
    """Whether a process has not ended yet, be it that nobody asked how."""
    with suppress(OSError):
        return stat(process)[0] != "Z"
    return False


def stat(process: int) -> list[str]:
    """State and parent of a process, and more."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()


def test_escape(compiling):
    start = time.monotonic()
    compiling.key("Escape")
    assert compiling.end() == (0, "", "")
    assert time.monotonic() - start < 1


def test_ctrl_c(compiling):
    start = time.monotonic()
    os.kill(compiling.process.pid, signal.SIGINT)
    assert compiling.end() == (130, "", "")
    assert time.monotonic() - start < 0.5


def test_a_preview_comes_first_and_then_the_picture(compiling):
    compiling.key("i", "i")
    between = slice(80, SIZE[1] - 60)  # the words above and below
    until(lambda: bool(compiling.desktop.screenshot(compiling.window)[between].any()), "the preview")
    preview = compiling.desktop.screenshot(compiling.window)
    right = picture(compiling.path)
    assert (preview != right).any()
    assert abs(preview[between].astype(int) - right[between]).mean() < 12
    compiling.shows(right)
    compiling.key("Escape")
    assert compiling.end() == (0, "", "")


def test_keys_work(compiling):
    compiling.key("i", "i", "Tab", "Tab", "Delete", "ctrl+s")
    until(lambda: compiling.path.read_text() != TEXT, "the saved scene")
    compiling.key("Tab")
    compiling.shows(picture(compiling.path))
    compiling.key("Escape")
    assert compiling.end() == (0, "", "")
