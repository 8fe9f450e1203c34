"""Whole programs in real windows: start, sleep, ticks and end."""

from __future__ import annotations

import itertools
import json
import os
import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.idle import switches, until_idle
from tests.paths import PACKAGE
from tests.processes import next_line
from tests.waiting import HANG_LIMIT, until

if TYPE_CHECKING:
    from tests.windows import Desktop

pytestmark = pytest.mark.window

GRADIENT = (PACKAGE / "mlx/README.md").read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
IDLE_LOOKS = 10  # consecutive looks that find the program asleep

SLEEPER = """
import signal, sys, threading
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
from minirt.mlx import Mlx
m = Mlx()
mlx = m.mlx_init()
win = m.mlx_new_window(mlx, 200, 100, "sleeper")
m.mlx_wake_hook(mlx, lambda _: print("loops", flush=True))
m.mlx_wake(mlx)
{setup}
try:
    m.mlx_loop(mlx)
except KeyboardInterrupt:
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    sys.exit(130)
"""

TICKS = "m.mlx_loop_hook(mlx, lambda _: None, None)"

# A line on standard input sends the signal to another thread than the main thread, which stays asleep.
ELSEWHERE = """
helper = threading.Thread(target=threading.Event().wait, daemon=True)
helper.start()
interrupt = lambda: sys.stdin.readline() and signal.pthread_kill(helper.ident, signal.SIGINT)
threading.Thread(target=interrupt, daemon=True).start()
"""

# After the first Ctrl+C, the next one is handled as usual.
HANG = """
def hang(_):
    handler = signal.getsignal(signal.SIGINT)
    print("hangs", flush=True)
    while signal.getsignal(signal.SIGINT) is handler:
        pass
    print("hangs on", flush=True)
    while True:
        pass
m.mlx_loop_hook(mlx, hang, None)
"""

OWN_HANDLER = "signal.signal(signal.SIGINT, lambda *_: (print('own'), m.mlx_loop_exit(mlx), m.mlx_wake(mlx)))"

AGAIN = """
m.mlx_release(mlx)
m.mlx_release(mlx)
mlx = m.mlx_init()
win = m.mlx_new_window(mlx, 200, 100, "again")
m.mlx_key_hook(win, lambda key, _: m.mlx_release(mlx), None)
"""


def sleeper(setup: str) -> tuple[str, ...]:
    """Command of the SLEEPER program with these lines of set-up."""
    return sys.executable, "-c", SLEEPER.format(setup=setup)


def outcome(process: subprocess.Popen[str]) -> tuple[int, str, str]:
    """Wait until a program ends by itself; return its status, standard output and standard error."""
    output, errors = process.communicate(timeout=HANG_LIMIT)
    return process.returncode, output, errors


def ctrl_c(process: subprocess.Popen[str]) -> None:
    """Send SIGINT to the process group, as a terminal does."""
    os.killpg(process.pid, signal.SIGINT)


def until_asleep(process: subprocess.Popen[str]) -> None:
    """Wait until a program sleeps."""
    until_idle(process.pid, itertools.count().__next__, IDLE_LOOKS)


@pytest.mark.parametrize("end", ["Escape", "close button"])
def test_the_gradient_is_shown_until_it_is_ended(desktop: Desktop, end: str) -> None:
    with desktop.program(sys.executable, "-W", "error", "-c", GRADIENT) as process:
        window = desktop.find("gradient")
        y, x = np.mgrid[:256, :512]
        expected = np.stack([x // 2, y, np.full_like(x, 64)], axis=-1)
        until(lambda: np.array_equal(desktop.screenshot(window), expected), "the gradient")
        if end == "Escape":
            desktop.key(window, end)
        else:
            desktop.close_button(window)
        assert outcome(process) == (0, "", "")


def test_a_program_without_loop_hook_sleeps_while_another_ticks(desktop: Desktop) -> None:
    with desktop.program(sys.executable, "-c", GRADIENT) as process, desktop.program(*sleeper(TICKS)) as other:
        desktop.find("gradient")
        assert next_line(other) == "loops"
        until_idle(process.pid, lambda: switches(other.pid), 30)


@pytest.mark.parametrize("setup", ["", TICKS])
def test_ctrl_c_ends_a_loop_that_sleeps_or_ticks(desktop: Desktop, setup: str) -> None:
    with desktop.program(*sleeper(setup)) as process:
        assert next_line(process) == "loops"
        if not setup:
            until_asleep(process)
        ctrl_c(process)
        assert outcome(process) == (130, "", "")


def test_ctrl_c_in_another_thread_ends_a_loop_that_sleeps(desktop: Desktop) -> None:
    with desktop.program(*sleeper(ELSEWHERE), stdin=subprocess.PIPE) as process:
        assert next_line(process) == "loops"
        until_asleep(process)
        assert process.stdin is not None
        process.stdin.write("now\n")
        process.stdin.flush()
        assert outcome(process) == (130, "", "")


def test_a_second_ctrl_c_stops_a_hook_that_hangs(desktop: Desktop) -> None:
    with desktop.program(*sleeper(HANG)) as process:
        assert [next_line(process), next_line(process)] == ["loops", "hangs"]
        ctrl_c(process)
        assert next_line(process) == "hangs on"
        ctrl_c(process)
        assert outcome(process) == (130, "", "")


def test_a_signal_handler_of_the_program_runs_at_once(desktop: Desktop) -> None:
    with desktop.program(*sleeper(OWN_HANDLER)) as process:
        assert next_line(process) == "loops"
        until_asleep(process)
        ctrl_c(process)
        assert outcome(process) == (0, "own\n", "")


def test_a_display_can_be_released_and_opened_again(desktop: Desktop) -> None:
    with desktop.program(*sleeper(AGAIN)) as process:
        desktop.key(desktop.find("again"), "a")
        assert outcome(process) == (0, "", "")


# Time advances in the waits of the loop, and in the eleventh call of the hook, which is slow.
PACE = """
import json
from minirt.mlx import Mlx

m = Mlx()
mlx = m.mlx_init()
m.mlx_new_window(mlx, 100, 50, "pace")

import pyglet.app
import pyglet.clock

loop = pyglet.app.platform_event_loop
wait = loop.step
now = pyglet.clock.get_default().time()
times = []

def step(timeout):
    global now
    now += timeout or 0.0
    return wait(timeout and 0.0)

def tick(_):
    global now
    times.append(now)
    if len(times) == 11:
        now += 0.1
    if len(times) == 41:
        m.mlx_loop_exit(mlx)

loop.step = step
pyglet.clock.get_default().time = lambda: now
m.mlx_loop_hook(mlx, tick, None)
m.mlx_loop(mlx)
print(json.dumps(times))
"""


def test_the_loop_hook_ticks_sixty_times_a_second_and_late_rather_than_twice(desktop: Desktop) -> None:
    with desktop.program(sys.executable, "-W", "error", "-c", PACE) as process:
        status, output, errors = outcome(process)
    assert (status, errors) == (0, "")
    times = json.loads(output)
    steps = [later - earlier for earlier, later in itertools.pairwise(times)]
    assert steps.pop(10) == pytest.approx(0.1)
    assert steps == pytest.approx([1 / 60] * 39)


def test_a_tick_that_is_a_little_late_does_not_delay_those_after_it(desktop: Desktop) -> None:
    late = PACE.replace("now += 0.1", "pass").replace("now += timeout or 0.0", "now += (timeout or 0.0) + 0.004")
    with desktop.program(sys.executable, "-W", "error", "-c", late) as process:
        status, output, errors = outcome(process)
    assert (status, errors) == (0, "")
    times = json.loads(output)
    assert (times[40] - times[20]) / 20 == pytest.approx(1 / 60, abs=1e-3)
