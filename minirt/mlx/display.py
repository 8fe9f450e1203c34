"""What `mlx_init` opens: the windows, the loop's hooks, and one turn of the loop. Both back ends run this same code."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from minirt.mlx.events import Button, Event
from minirt.mlx.handles import Bound, Window

if TYPE_CHECKING:
    from collections.abc import Iterable

    from minirt.mlx.backend import Backend
    from minirt.mlx.keys import Modifier


class Display:
    """The state that MiniLibX keeps between its calls. Of its methods, `wake` alone may be called from any thread."""

    def __init__(self, backend: Backend) -> None:
        self.backend = backend
        self.windows: list[Window] = []
        self.loop_hook: Bound | None = None
        self.wake_hook: Bound | None = None
        self.autorepeat = False
        self.is_open = True
        self.running = False  # inside mlx_loop
        self.ending = False
        self.failure: BaseException | None = None  # what a hook raised
        self._closing: list[Window] = []  # destroyed by the program, still open on the screen
        self._depth = 0  # hooks being called
        self._woken = threading.Event()

    # --- the program's side ---

    def loop(self) -> None:
        """Run until the program ends it, a hook raises (raised again here), or no window is left."""
        self.running = True
        try:
            if self.windows:
                self.backend.run()
        finally:
            self.running = self.ending = False
            self._close_destroyed()
        self.raise_failure()

    def raise_failure(self) -> None:
        """Raise what a hook raised, once."""
        failure, self.failure = self.failure, None
        if failure is not None:
            raise failure

    def destroy(self, window: Window) -> None:
        """Close a window: at once where that is safe, or else at the end of the turn. No hook of it is called again."""
        if window.is_open:
            window.is_open = False
            self.windows.remove(window)
            self._closing.append(window)
            if not self.running and not self._depth:
                self._close_destroyed()

    def close(self) -> None:
        """Close everything; a running loop ends."""
        if self.is_open:
            for window in list(self.windows):
                self.destroy(window)
            self.is_open = False
            self.ending = True
            if not self.running:
                self.backend.close()

    def wake(self) -> None:
        """From any thread: make a sleeping loop take a turn, with the wake hook."""
        self._woken.set()
        if self.is_open:
            self.backend.wake()

    # --- the back end's side ---

    @property
    def over(self) -> bool:
        """Whether the loop has to end."""
        return self.ending or self.failure is not None or not self.windows

    @property
    def busy(self) -> bool:
        """Whether the loop has to tick; otherwise it sleeps until an event or a call of `wake`."""
        repeating = self.autorepeat and any(window.keyboard.repeating for window in self.windows)
        return self.loop_hook is not None or repeating

    @property
    def woken(self) -> bool:
        return self._woken.is_set()

    def fail(self, failure: BaseException) -> None:
        """End the loop and raise `failure` from it; the first one counts."""
        self.failure = self.failure or failure

    def call(self, bound: Bound | None, *arguments: object) -> None:
        """Call a hook. What it raises, even SystemExit, is kept for the end of the loop: a platform would lose it."""
        if bound is None or self.ending or self.failure is not None:
            return
        hook, parameter = bound
        self._depth += 1
        try:
            hook(*arguments, parameter)
        except BaseException as failure:
            self.fail(failure)
        finally:
            self._depth -= 1

    def turn(self, *, tick: bool) -> None:
        """One turn of the loop, after its events; `tick`: at the pace of the loop hook. Draws what has changed."""
        for window in list(self.windows):
            self._tell(window)
        if self._woken.is_set():
            self._woken.clear()
            self.call(self.wake_hook)
        if tick and self.windows:
            self.call(self.loop_hook)
        self._close_destroyed()
        for window in self.windows:
            if window.visible and (window.stale or window.shown.changes):
                self.show(window)

    def show(self, window: Window) -> None:
        """Bring the canvas to the screen now."""
        window.stale = False
        self.backend.show(window)

    def _tell(self, window: Window) -> None:
        """What is told once a turn, however many events said so."""
        if not window.announced:
            window.announced = True
            window.deliver(Event.MAP_NOTIFY)
            window.deliver(Event.EXPOSE)
        if window.resized:
            window.resized = False
            window.deliver(Event.CONFIGURE_NOTIFY)
            if window.is_open:
                self.call(window.resize_hook, window.width, window.height)
        if self.autorepeat:
            window.keyboard.repeat(self.backend.time())

    def _close_destroyed(self) -> None:
        while self._closing:
            self.backend.close_window(self._closing.pop())
        if not self.is_open and not self.running:
            self.backend.close()

    # --- events, as back ends report them ---

    def press(self, window: Window, key: int, modifiers: Modifier | None = None) -> None:
        """A key goes down; `modifiers` as in `Keyboard.press`."""
        window.keyboard.press(key, self.backend.time(), modifiers)

    def text(self, window: Window, text: str) -> None:
        """Text was typed; control characters are not text."""
        if window.is_open and text.isprintable():
            self.call(window.text_hook, text)

    def drop(self, window: Window, files: Iterable[str]) -> None:
        """Files were dropped on the window."""
        for file in files:
            if window.is_open:
                self.call(window.drop_hook, file)

    def move(self, window: Window, x: int, y: int) -> None:
        """The pointer is at x, y from the top left corner; outside, it is taken to the border."""
        window.pointer = min(max(x, 0), window.width - 1), min(max(y, 0), window.height - 1)

    def button(self, window: Window, event: Event, button: int, x: int, y: int) -> None:
        self.move(window, x, y)
        window.deliver(event, button, *window.pointer)

    def motion(self, window: Window, x: int, y: int) -> None:
        self.move(window, x, y)
        window.deliver(Event.MOTION_NOTIFY, *window.pointer)

    def scroll(self, window: Window, right: int, up: int, x: int, y: int) -> None:
        """Steps of the wheel; negative ones go left and down."""
        steps = [Button.WHEEL_UP if up > 0 else Button.WHEEL_DOWN] * abs(up)
        steps += [Button.WHEEL_RIGHT if right > 0 else Button.WHEEL_LEFT] * abs(right)
        for step in steps:
            self.button(window, Event.BUTTON_PRESS, step, x, y)
            self.button(window, Event.BUTTON_RELEASE, step, x, y)

    def focus(self, window: Window, focused: bool) -> None:
        if not focused:
            window.keyboard.release_all()
        window.deliver(Event.FOCUS_IN if focused else Event.FOCUS_OUT)

    def resize(self, window: Window, width: int, height: int) -> None:
        """The framebuffer has this size now. The program is told at the next turn, with the latest size."""
        window.stale = True
        if window.resizable and (width, height) != (window.width, window.height):
            window.width, window.height = width, height
            window.resized = True

    def expose(self, window: Window) -> None:
        window.stale = True
        window.deliver(Event.EXPOSE)

    def set_visible(self, window: Window, visible: bool) -> None:
        """Hidden and minimised windows are not drawn; everything else goes on."""
        if visible != window.visible:
            window.visible = visible
            window.stale = True
            window.deliver(Event.MAP_NOTIFY if visible else Event.UNMAP_NOTIFY)

    def close_button(self, window: Window) -> None:
        window.deliver(Event.DESTROY_NOTIFY)
        window.deliver(Event.CLIENT_MESSAGE)
