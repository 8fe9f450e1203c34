"""Rate of the loop hook on the screen, by a simulated clock; test_memory tests that of `Memory`."""

from __future__ import annotations

import itertools
import json
import sys
from typing import TYPE_CHECKING

import pytest

from tests.waiting import HANG_LIMIT

if TYPE_CHECKING:
    from tests.windows import Desktop

pytestmark = pytest.mark.window

# Time advances in the waits of the loop, and in the eleventh call of the hook, which is slow.
PROGRAM = """
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
    with desktop.program(sys.executable, "-W", "error", "-c", PROGRAM) as process:
        output, errors = process.communicate(timeout=HANG_LIMIT)
    assert (process.returncode, errors) == (0, "")
    times = json.loads(output)
    steps = [later - earlier for earlier, later in itertools.pairwise(times)]
    assert steps.pop(10) == pytest.approx(0.1)
    assert steps == pytest.approx([1 / 60] * 39)
