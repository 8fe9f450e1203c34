"""PygletDisplay: windows by pyglet, and an event loop that sleeps while nothing happens."""

from __future__ import annotations

import pyglet.app
import pyglet.clock
import pyglet.display
from pyglet.app.base import EventLoop

from minirt.helpers.signals import interruptible
from minirt.mlx.display import TICK, Display
from minirt.mlx.on_pyglet.native import NativeWindow
from minirt.mlx.on_pyglet.x11 import end_program_when_connection_is_lost


class PygletDisplay(Display):
    """A back end on pyglet. Turns are scheduled on pyglet's clock, which every platform runs even during a resize."""

    window_type = NativeWindow

    def __init__(self) -> None:
        super().__init__()
        self._requested = False  # a turn is scheduled
        self._next_tick: float | None = None  # when it is due, in seconds of pyglet's clock

    def run(self) -> None:
        self.request_turn()
        # On some Macs pyglet uses another loop, which cannot sleep: it ticks.
        interval = None if type(pyglet.app.event_loop) is EventLoop else TICK
        end_program_when_connection_is_lost(self.lost)
        with interruptible(lambda: self.fail(KeyboardInterrupt()), self.wake_up):
            pyglet.app.event_loop.run(interval)
        self._tick_while(False)

    def wake_up(self) -> None:
        pyglet.app.platform_event_loop.post_event(self, "wake")

    def dispatch_event(self, _name: str) -> None:
        """Request a turn: pyglet calls this in the main thread for a posted event."""
        self.request_turn()

    def request_turn(self) -> None:
        if not self._requested:
            self._requested = True
            pyglet.clock.schedule_once(self._turn, 0)

    def screen_size(self) -> tuple[int, int]:
        screen = pyglet.display.get_display().get_default_screen()
        return int(screen.width), int(screen.height)

    def _turn(self, _seconds: float) -> None:
        self._requested = False
        self._take_turn(tick=False)

    def _tick(self, _seconds: float) -> None:
        """Take a turn that ticks, and schedule the next one TICK after this one was due, or late after a slow turn.

        Intervals of pyglet's clock begin when the last one is handled, late or not: with 9 ms of drawing that gave 56
        ticks a second in place of 59.
        """
        assert self._next_tick is not None
        now = pyglet.clock.get_default().time()
        self._schedule_tick(now, self._next_tick if self._next_tick + TICK > now else now)
        self._take_turn(tick=True)

    def _schedule_tick(self, now: float, last: float) -> None:
        """Schedule a tick TICK after the last one, in seconds of pyglet's clock."""
        self._next_tick = last + TICK
        pyglet.clock.schedule_once(self._tick, self._next_tick - now)

    def _take_turn(self, *, tick: bool) -> None:
        """Perform the actions, take a turn, and end pyglet's loop when it is over."""
        if not self.running:
            return  # scheduled in a loop that has ended
        self.perform_actions()
        if not self.over:
            self.turn(tick=tick)
        self._tick_while(self.busy)
        if self.over:
            pyglet.app.event_loop.exit()

    def _tick_while(self, busy: bool) -> None:
        if busy and self._next_tick is None:
            now = pyglet.clock.get_default().time()
            self._schedule_tick(now, now)
        elif not busy:
            pyglet.clock.unschedule(self._tick)
            self._next_tick = None
