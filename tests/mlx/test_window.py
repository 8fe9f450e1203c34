"""Whole programs in real windows: how they start, sleep and end."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.windows import until

if TYPE_CHECKING:
    import subprocess

    from tests.windows import Desktop

pytestmark = pytest.mark.window

GRADIENT = str(Path(__file__).with_name("gradient.py"))

SLEEPER = """
import signal, sys, threading
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
from minirt.mlx import Mlx
m = Mlx()
mlx = m.mlx_init()
win = m.mlx_new_window(mlx, 200, 100, "sleeper")
helper = threading.Thread(target=threading.Event().wait, daemon=True)
helper.start()
{setup}
try:
    m.mlx_loop(mlx)
except KeyboardInterrupt:
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    sys.exit(130)
"""


def outcome(process: subprocess.Popen[str]) -> tuple[int, str, str]:
    """Status, standard output and standard error of a program that has to end by itself."""
    output, errors = process.communicate(timeout=10)
    return process.returncode, output, errors


def test_the_gradient_is_shown_and_escape_ends_it(desktop: Desktop) -> None:
    with desktop.program(sys.executable, "-W", "error", GRADIENT) as process:
        window = desktop.find("gradient")
        y, x = np.mgrid[:256, :512]
        expected = np.stack([x // 2, y, np.full_like(x, 64)], axis=-1)
        until(lambda: np.array_equal(desktop.screenshot(window), expected), "the gradient")
        desktop.key(window, "Escape")
        assert outcome(process) == (0, "", "")


def test_the_close_button_ends_it(desktop: Desktop) -> None:
    with desktop.program(sys.executable, "-W", "error", GRADIENT) as process:
        desktop.close_button(desktop.find("gradient"))
        assert outcome(process) == (0, "", "")


def test_a_program_without_loop_hook_sleeps(desktop: Desktop) -> None:
    def used() -> float:
        fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    with desktop.program(sys.executable, GRADIENT) as process:
        desktop.find("gradient")
        time.sleep(0.5)
        before = used()
        time.sleep(1.0)
        assert used() - before <= 0.02


@pytest.mark.parametrize(
    "setup",
    [
        "",
        "m.mlx_loop_hook(mlx, lambda _: None, None)",
        # The signal comes to a thread that is not the main one, which sleeps on undisturbed.
        "threading.Timer(0.8, lambda: signal.pthread_kill(helper.ident, signal.SIGINT)).start()",
    ],
    ids=["asleep", "ticking", "in another thread"],
)
def test_ctrl_c_ends_the_loop(desktop: Desktop, setup: str) -> None:
    with desktop.program(sys.executable, "-c", SLEEPER.format(setup=setup)) as process:
        desktop.find("sleeper")
        time.sleep(0.2)
        start = time.monotonic()
        if "pthread_kill" not in setup:
            process.send_signal(signal.SIGINT)
        assert outcome(process) == (130, "", "")
        assert time.monotonic() - start < 2.0


def test_a_second_ctrl_c_stops_a_hook_that_hangs(desktop: Desktop) -> None:
    hang = """
def hang(_):
    print("hangs", flush=True)
    while True:
        pass
m.mlx_loop_hook(mlx, hang, None)
"""
    with desktop.program(sys.executable, "-c", SLEEPER.format(setup=hang)) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "hangs\n"
        for _ in range(2):
            process.send_signal(signal.SIGINT)
            time.sleep(0.2)
        assert outcome(process) == (130, "", "")


def test_a_handler_of_the_program_s_own_runs_at_once(desktop: Desktop) -> None:
    handler = "signal.signal(signal.SIGINT, lambda *_: (print('own'), m.mlx_loop_exit(mlx), m.mlx_wake(mlx)))"
    with desktop.program(sys.executable, "-c", SLEEPER.format(setup=handler)) as process:
        desktop.find("sleeper")
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        assert outcome(process) == (0, "own\n", "")


def test_a_display_can_be_released_and_opened_again(desktop: Desktop) -> None:
    again = """
m.mlx_release(mlx)
m.mlx_release(mlx)
mlx = m.mlx_init()
win = m.mlx_new_window(mlx, 200, 100, "again")
m.mlx_key_hook(win, lambda key, _: m.mlx_release(mlx), None)
"""
    with desktop.program(sys.executable, "-c", SLEEPER.format(setup=again)) as process:
        desktop.key(desktop.find("again"), "a")
        assert outcome(process) == (0, "", "")
