"""The back end without a screen, beyond the contract: simulated time, single steps, and programs that do not end."""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest

import minirt.mlx.arguments as arguments_module
import minirt.mlx.memory as memory_module
from minirt.mlx import Event, Key, Mlx, MlxError, Modifier
from minirt.mlx.display import TICK
from minirt.mlx.memory import Memory

if TYPE_CHECKING:
    from minirt.mlx import Window
    from minirt.mlx.arguments import Hook


def opened(width: int, height: int, patience: float = 30.0) -> tuple[Memory, Mlx, Memory, Window]:
    """Open a window of this size in memory."""
    memory = Memory(patience=patience)
    m = Mlx(memory)
    mlx = m.mlx_init()
    return memory, m, mlx, m.mlx_new_window(mlx, width, height, "window")


def test_time_is_simulated() -> None:
    memory, m, mlx, _ = opened(10, 10)
    times: list[float] = []
    m.mlx_loop_hook(mlx, lambda _: times.append(m.mlx_time(mlx)), None)
    memory.wait(0.5)
    memory.play()
    assert times == pytest.approx([TICK * (i + 1) for i in range(30)])
    memory.wait(0.001)
    memory.play()
    assert times[30:] == pytest.approx([0.501])


def test_play_steps_without_a_loop_and_raises() -> None:
    memory, m, _, win = opened(10, 10)
    m.mlx_set_options(strict=True)
    seen: list[object] = []
    m.mlx_hook(win, Event.KEY_PRESS, 0, lambda key, _: seen.append((key, m.mlx_get_modifiers(win))), None)
    memory.tap(Key.CONTROL_L, Key.Z)
    memory.play()
    assert seen == [(Key.CONTROL_L, Modifier.CTRL), (Key.Z, Modifier.CTRL)]
    assert m.mlx_get_modifiers(win) == Modifier.NONE
    m.mlx_hook(win, Event.KEY_PRESS, 0, lambda *_: 1 / 0, None)
    memory.press(Key.A)
    with pytest.raises(ZeroDivisionError):
        memory.play()


PATIENCE = 20.0  # simulated seconds


class Clock:
    """A clock for `Memory` that advances by the time of each wait, and by a little at each reading."""

    def __init__(self) -> None:
        self.now = 1000.0

    def monotonic(self) -> float:
        self.now += 0.125
        assert self.now < 2000.0, "the loop does not end"
        return self.now

    def event(self) -> threading.Event:
        """Make an event that is never set."""
        event = threading.Event()

        def wait(timeout: float | None = None) -> bool:
            assert timeout is not None, "a wait without a limit"
            self.now += timeout
            return event.is_set()

        event.wait = wait  # type: ignore[method-assign]
        return event


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Replace the machine's clock by a simulated one."""
    simulated = Clock()
    monkeypatch.setattr(memory_module, "time", SimpleNamespace(monotonic=simulated.monotonic))
    monkeypatch.setattr(arguments_module, "threading", SimpleNamespace(Event=simulated.event))
    return simulated


def tick(ticks: list[int]) -> None:
    """Count the ticks of a loop that must end."""
    ticks.append(1)
    assert len(ticks) < 10_000, "the loop does not end"


@pytest.mark.parametrize("hook", [None, tick], ids=["asleep", "ticking"])
def test_a_program_that_does_not_end_raises(clock: Clock, hook: Hook | None) -> None:
    _, m, mlx, _ = opened(10, 10, PATIENCE)
    m.mlx_loop_hook(mlx, hook, [])
    start = clock.now
    with pytest.raises(MlxError, match=r"did not end within 20\.0 s"):
        m.mlx_loop(mlx)
    assert clock.now - start == pytest.approx(PATIENCE, abs=0.5)


def test_a_window_of_fixed_size_keeps_it() -> None:
    """A window of fixed size that is shown larger keeps its size, and its picture is stretched."""
    memory, m, mlx, win = opened(2, 1)
    m.mlx_resize_hook(win, lambda *_: pytest.fail("it has not changed"))
    memory.resize(4, 2)
    memory.play()
    m.mlx_pixel_put(mlx, win, 1, 0, 0xFF0000FF)
    memory.play()
    assert m.mlx_get_window_size(win) == (0, 2, 1)
    assert memory.screenshot()[..., 0].tolist() == [[0, 0, 255, 255]] * 2
