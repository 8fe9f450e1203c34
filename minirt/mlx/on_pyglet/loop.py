"""The back end on pyglet: `PygletBackend`, and the event loop that sleeps when there is nothing to do."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

import pyglet.app
import pyglet.clock
import pyglet.display
from pyglet.app.base import EventLoop

from minirt.errors import MlxError
from minirt.mlx.backend import Backend
from minirt.mlx.on_pyglet.interrupt import interruptible
from minirt.mlx.on_pyglet.native import NativeWindow

if TYPE_CHECKING:
    from collections.abc import Callable

    from minirt.mlx.display import Display
    from minirt.mlx.handles import Window

TICK = 1 / 60  # seconds between two turns of a busy loop


class PygletBackend(Backend):
    """Turns are functions of pyglet's clock: every platform calls those, even while a window is being resized."""

    def __init__(self) -> None:
        self._natives: dict[Window, NativeWindow] = {}
        self._requested = False  # a turn will come
        self._ticking = False
        self._before_turn: list[Callable[[], None]] = []  # what may not happen inside a handler of pyglet

    def open(self, display: Display) -> None:
        self._display = display
        self._screen = pyglet.display.get_display().get_default_screen()

    def close(self) -> None:
        """Nothing is left: pyglet keeps its connection to the screen for as long as the program runs."""

    def open_window(self, window: Window) -> None:
        try:
            self._natives[window] = NativeWindow(window, self._request_turn)
        except Exception as error:  # whatever pyglet says here, there is no window
            raise MlxError(f"no window with OpenGL 3.3 can be opened ({error}); -o FILE renders without one") from error

    def close_window(self, window: Window) -> None:
        self._natives.pop(window).pyglet.close()

    def show(self, window: Window) -> None:
        self._natives[window].draw()

    def run(self) -> None:
        self._request_turn()
        # On some Macs pyglet has another loop, which cannot sleep: there it ticks.
        interval = None if type(pyglet.app.event_loop) is EventLoop else TICK
        with interruptible(lambda: self._display.fail(KeyboardInterrupt()), self.wake):
            pyglet.app.event_loop.run(interval)
        self._tick_while(False)

    def wake(self) -> None:
        pyglet.app.platform_event_loop.post_event(self, "wake")

    def dispatch_event(self, _name: str) -> None:
        """How pyglet hands a posted event to the main thread."""
        self._request_turn()

    def time(self) -> float:
        return time.perf_counter()

    def screen_size(self) -> tuple[int, int]:
        return int(self._screen.width), int(self._screen.height)

    def set_title(self, window: Window) -> None:
        self._natives[window].pyglet.set_caption(window.title)

    def set_fullscreen(self, window: Window, on: bool) -> None:
        self._before_turn.append(partial(self._set_fullscreen, window, on))
        self._request_turn()

    def move_pointer(self, window: Window, x: int, y: int) -> None:
        self._natives[window].move_pointer(x, y)

    def show_pointer(self, window: Window, on: bool) -> None:
        self._natives[window].pyglet.set_mouse_visible(on)

    def clipboard(self, window: Window) -> str:
        return str(self._natives[window].pyglet.get_clipboard_text())

    def set_clipboard(self, window: Window, text: str) -> None:
        self._natives[window].pyglet.set_clipboard_text(text)

    def _set_fullscreen(self, window: Window, on: bool) -> None:
        if window in self._natives:
            self._natives[window].set_fullscreen(on)

    def _request_turn(self) -> None:
        if not self._requested:
            self._requested = True
            pyglet.clock.schedule_once(self._turn, 0)

    def _turn(self, _seconds: float) -> None:
        self._requested = False
        self._take_turn(tick=False)

    def _tick(self, _seconds: float) -> None:
        self._take_turn(tick=True)

    def _take_turn(self, *, tick: bool) -> None:
        if not self._display.running:
            return  # asked for in a loop that is over
        actions, self._before_turn = self._before_turn, []
        for action in actions:
            action()
        if not self._display.over:
            self._display.turn(tick=tick)
        self._tick_while(self._display.busy)
        if self._display.over:
            pyglet.app.event_loop.exit()

    def _tick_while(self, busy: bool) -> None:
        if busy and not self._ticking:
            pyglet.clock.schedule_interval(self._tick, TICK)
        elif self._ticking and not busy:
            pyglet.clock.unschedule(self._tick)
        self._ticking = busy
