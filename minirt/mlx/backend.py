"""Backend: the contract of a window system, which shows canvases on a screen and reports events to windows.

Display, which all back ends share: the open windows, the hooks of the event loop, and one turn of the loop.
"""

from __future__ import annotations

import sys
import threading
import time
import traceback
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from minirt.mlx.arguments import Handle
from minirt.mlx.events import Event

if TYPE_CHECKING:
    from minirt.mlx.arguments import BoundHook, Hook, Options
    from minirt.mlx.window import Window


TICK = 1 / 60  # seconds between two turns of a busy loop
ADVICE = "-o FILE renders without one"  # the end of an error where no window can be opened


class Backend(ABC):
    """A window system for one display at a time. All methods but `wake` are called from the thread that called `open`.

    A back end reports events to `Window.on_…` and `Window.keyboard` from inside `run`, and calls `Display.turn` once
    after all events that came together. It draws from `Window.shown` and writes nothing there. Methods that are not
    abstract may be missing, where the platform has no title bar or cannot move the pointer.
    """

    clipboard_text = ""

    @abstractmethod
    def open(self, display: Display) -> None:
        """Connect to the screen. Raises MlxError with the reason where there is none."""

    def close(self) -> None:  # noqa: B027
        """Disconnect from the screen; all windows are closed before."""

    @abstractmethod
    def open_window(self, window: Window) -> None:
        """Show a new window, and set the size that a resizable window really got. Raises MlxError."""

    def close_window(self, window: Window) -> None:  # noqa: B027
        """Take the window from the screen. Never called inside a hook."""

    @abstractmethod
    def show(self, window: Window) -> None:
        """Bring `window.shown` to the screen now, stretched to the window (nearest pixel) if the sizes differ."""

    @abstractmethod
    def run(self) -> None:
        """Deliver events and take turns until `Display.over`.

        While `Display.busy`, a turn with `tick=True` comes about 60 times a second, late rather than twice.
        Otherwise the loop sleeps, and uses no processor, until an event or `wake`. Ctrl+C ends it with
        KeyboardInterrupt even then.
        """

    @abstractmethod
    def wake(self) -> None:
        """Make `run` take a turn soon. May be called from any thread; calls that come together may share one turn."""

    def time(self) -> float:
        """Seconds of a clock that never runs backwards."""
        return time.perf_counter()

    @abstractmethod
    def screen_size(self) -> tuple[int, int]:
        """Width and height of the screen in pixels."""

    def set_title(self, window: Window) -> None:  # noqa: B027
        """Show `window.title`."""

    @abstractmethod
    def set_fullscreen(self, window: Window, on: bool) -> None:
        """Cover the screen, or return to the size before; the new size is reported as a resize."""

    def move_pointer(self, window: Window, x: int, y: int) -> None:  # noqa: B027
        """Move the pointer to x, y from the window's top left corner."""

    @abstractmethod
    def show_pointer(self, window: Window, on: bool) -> None:
        """Show or hide the pointer over the window."""

    def set_cursor(self, window: Window) -> None:  # noqa: B027
        """Give the pointer the shape of `window.cursor`."""

    def set_icons(self, window: Window) -> None:  # noqa: B027
        """Show one of `window.icons` where the desktop shows an icon of the window."""

    def clipboard(self, window: Window) -> str:
        """The text on the clipboard, or an empty string; that of this program alone if the platform has none."""
        return self.clipboard_text

    def set_clipboard(self, window: Window, text: str) -> None:
        """Put text on the clipboard."""
        self.clipboard_text = text


class Display(Handle):
    """The state that MiniLibX keeps between its calls. Only `wake` may be called from any thread."""

    def __init__(self, backend: Backend, options: Options) -> None:
        self.backend = backend
        self.options = options
        self.windows: list[Window] = []
        self.loop_hook: BoundHook | None = None
        self.wake_hook: BoundHook | None = None
        self.lost_hook: BoundHook | None = None
        self.autorepeat = True
        self.is_open = True
        self.running = False  # inside mlx_loop
        self.ending = False
        self.failure: BaseException | None = None  # raised by a hook
        self._closing: list[Window] = []  # destroyed by the program, still on the screen
        self._depth = 0  # hooks that are being called now, one inside another
        self._woken = threading.Event()

    # --- the program's side ---

    def loop(self) -> None:
        """Run until the program ends it, an exception has to be raised from here, or no window is left."""
        self.running = True
        self.ending = not self.is_open
        try:
            if self.windows:
                self.backend.run()
        finally:
            self.running = self.ending = False
            self._close_destroyed()
        self.raise_failure()

    def raise_failure(self) -> None:
        """Raise the exception of a hook, if there is one, once."""
        failure, self.failure = self.failure, None
        if failure is not None:
            raise failure

    def destroy(self, window: Window) -> None:
        """Close a window: at once if that is safe, otherwise at the end of the turn. Its hooks are silent then."""
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
        """Make a sleeping loop take a turn, which calls the wake hook. May be called from any thread."""
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
        """Whether `wake` was called since the last turn."""
        return self._woken.is_set()

    def fail(self, failure: BaseException) -> None:
        """End the loop and raise `failure` from it; of several failures the first is raised."""
        self.failure = self.failure or failure

    def call(self, hook: BoundHook | None, *arguments: object) -> None:
        """Call a hook. Its exception, even SystemExit, is reported, and the loop goes on.

        With `Options.strict` it ends the loop, which raises it: raised at once, a platform would lose it.
        """
        if hook is None or self.ending or self.failure is not None:
            return
        function, parameter = hook
        self._depth += 1
        try:
            function(*arguments, parameter)
        except BaseException as failure:
            if self.options.strict or not isinstance(failure, Exception | SystemExit):
                self.fail(failure)
            else:
                _report(function, failure)
        finally:
            self._depth -= 1

    def turn(self, *, tick: bool) -> None:
        """Take one turn of the loop after its events, and draw changed windows. `tick`: call the loop hook, too."""
        for window in list(self.windows):
            self._deliver_pending(window)
        if self._woken.is_set():
            self._woken.clear()
            self.call(self.wake_hook)
        if tick and self.windows:
            self.call(self.loop_hook)
        self._close_destroyed()
        for window in self.windows:
            if window.visible and (window.stale or window.shown.changes):
                self.show(window)

    def lost(self) -> None:
        """The connection to the screen is lost: call the hook for that. The back end ends the program after it."""
        if self.lost_hook:
            function, parameter = self.lost_hook
            function(parameter)

    def show(self, window: Window) -> None:
        """Bring the canvas to the screen now."""
        window.stale = False
        self.backend.show(window)

    def _deliver_pending(self, window: Window) -> None:
        """Deliver the events that are merged to one a turn: first exposure, resize, key repeat."""
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


def _report(hook: Hook, failure: BaseException) -> None:
    """Print the exception of a hook, as Python does for those that it cannot raise."""
    print(f"Exception ignored in the hook {getattr(hook, '__qualname__', hook)}:", file=sys.stderr)
    traceback.print_exception(failure)
