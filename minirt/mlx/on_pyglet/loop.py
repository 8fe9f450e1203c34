"""PygletBackend: windows by pyglet, and an event loop that sleeps while nothing happens."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import pyglet.app
import pyglet.clock
import pyglet.display
from pyglet.app.base import EventLoop

from minirt.errors import MlxError
from minirt.mlx.backend import ADVICE, TICK, Backend
from minirt.mlx.on_pyglet.interrupt import end_program_when_connection_is_lost, interruptible
from minirt.mlx.on_pyglet.native import NativeWindow

if TYPE_CHECKING:
    from collections.abc import Callable

    from minirt.mlx.backend import Display
    from minirt.mlx.window import Window


class PygletBackend(Backend):
    """A back end on pyglet. Turns are scheduled on pyglet's clock, which every platform runs even during a resize."""

    def __init__(self) -> None:
        self._natives: dict[Window, NativeWindow] = {}
        self._requested = False  # a turn is scheduled
        self._ticking = False
        self._before_turn: list[Callable[[], None]] = []  # actions that are not allowed inside a pyglet event handler

    def open(self, display: Display) -> None:
        self._display = display
        self._screen = pyglet.display.get_display().get_default_screen()

    def open_window(self, window: Window) -> None:
        try:
            self._natives[window] = NativeWindow(window, self.time, self._request_turn)
        except Exception as error:  # any error of pyglet means that there is no window
            raise MlxError(f"no window with OpenGL 3.3 can be opened ({error}); {ADVICE}") from error

    def close_window(self, window: Window) -> None:
        self._natives.pop(window).pyglet.close()

    def show(self, window: Window) -> None:
        self._natives[window].draw()

    def run(self) -> None:
        self._request_turn()
        # On some Macs pyglet uses another loop, which cannot sleep: it ticks.
        interval = None if type(pyglet.app.event_loop) is EventLoop else TICK
        end_program_when_connection_is_lost(self._display.lost)
        with interruptible(lambda: self._display.fail(KeyboardInterrupt()), self.wake):
            pyglet.app.event_loop.run(interval)
        self._tick_while(False)

    def wake(self) -> None:
        pyglet.app.platform_event_loop.post_event(self, "wake")

    def dispatch_event(self, _name: str) -> None:
        """Request a turn: pyglet calls this in the main thread for a posted event."""
        self._request_turn()

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

    def set_cursor(self, window: Window) -> None:
        self._natives[window].pyglet.set_cursor(window.cursor)

    def set_icons(self, window: Window) -> None:
        self._natives[window].pyglet.set_icons(window.icons)

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
        """Run the deferred actions, take a turn of the display, and end pyglet's loop when it is over."""
        if not self._display.running:
            return  # scheduled in a loop that has ended
        actions, self._before_turn = self._before_turn, []
        for action in actions:
            action()
        if not self._display.over:
            self._display.turn(tick=tick)
        self._tick_while(self._display.busy)
        if self._display.over:
            pyglet.app.event_loop.exit()

    def _tick_while(self, busy: bool) -> None:
        """Start or stop the ticks."""
        if busy and not self._ticking:
            pyglet.clock.schedule_interval(self._tick, TICK)
        elif self._ticking and not busy:
            pyglet.clock.unschedule(self._tick)
        self._ticking = busy
