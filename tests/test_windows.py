"""The desktop for tests of windows: its start, its errors, and its cleanup."""

from __future__ import annotations

import os
import signal
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.waiting import HANG_LIMIT
from tests.windows import MANAGER_VARIABLE, Desktop, open_desktop

WINDOW = """
from minirt.mlx import Mlx
m = Mlx()
mlx = m.mlx_init()
m.mlx_new_window(mlx, 20, 10, "small")
m.mlx_loop(mlx)
"""


@pytest.mark.window
def test_a_desktop_whose_window_manager_does_not_start_leaves_no_display(desktop, tmp_path, monkeypatch):
    broken = tmp_path / "openbox"
    broken.write_text(f'#!/bin/sh\necho "$DISPLAY" >{tmp_path}/display\nexit 1\n')
    broken.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    with pytest.raises(RuntimeError, match="openbox did not start"), open_desktop():
        pass
    display = (tmp_path / "display").read_text().strip()
    assert not Desktop(desktop.environment | {"DISPLAY": display}).is_managed()
    assert not Path(f"/tmp/.X11-unix/X{display[1:]}").exists()


@pytest.mark.window
def test_a_program_leaves_no_window(desktop):
    with desktop.program(sys.executable, "-c", WINDOW) as process:
        window = desktop.find("small")
        assert desktop.exists(window)
        assert desktop.windows() == [(window, "small")]
    assert process.wait(HANG_LIMIT) < 0
    assert desktop.windows() == []
    assert not desktop.exists(window)


@pytest.mark.window
def test_a_program_ends_when_the_window_manager_knows_that_its_window_is_closed(desktop, monkeypatch):
    manager = int(desktop.environment[MANAGER_VARIABLE])
    looks = []

    def look():
        looks.append(1)
        try:
            return Desktop(desktop.environment).windows()
        finally:
            os.kill(manager, signal.SIGCONT)

    with ExitStack() as stack:
        with desktop.program(sys.executable, "-c", WINDOW):
            desktop.find("small")
            monkeypatch.setattr(desktop, "windows", look)
            stack.enter_context(desktop.manager_paused())
        assert len(looks) > 1


@pytest.mark.window
def test_a_program_that_opens_no_window_fails_at_once_and_says_why(desktop):
    with (
        desktop.program(sys.executable, "-c", "import sys; sys.exit('no such scene')"),
        pytest.raises(AssertionError, match="no such scene"),
    ):
        desktop.find("small")
