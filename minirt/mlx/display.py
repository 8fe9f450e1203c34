"""Display: the contract of a back end, which is a window system; its open windows, and one turn of its loop."""

from __future__ import annotations

import threading
from abc import abstractmethod

from minirt.mlx.arguments import Host, Options
from minirt.mlx.events import Event
from minirt.mlx.window import Window

TICK = 1 / 60  # seconds between two turns of a busy loop
NO_WINDOW = "no window can be opened"  # the beginning of an error


class Display(Host):
    """A window system. All methods but `do`, `wake` and `wake_up` are called from the thread that called `open`.

    A back end derives from this class and from `Window`. It reports events to `Window.on_…` and `Window.keyboard` from
    inside `run`, and calls `turn` once after all events that came together.
    """

    window_type: type[Window]  # its windows, which raise MlxError where they cannot be opened

    def __init__(self) -> None:
        super().__init__()
        self.windows: list[Window] = []
        self.autorepeat = True
        self.is_open = False
        self.running = False  # inside mlx_loop
        self._closing: list[Window] = []  # destroyed by the program, still on the screen
        self.woken = threading.Event()  # `wake` was called since the last turn

    # --- what a back end does ---

    def open(self, options: Options) -> None:
        """Connect to the screen. Raises MlxError with the reason where there is none."""
        self.options = options
        self.hooks.clear()
        self.autorepeat = self.is_open = True
        self.ending = False

    @abstractmethod
    def run(self) -> None:
        """Deliver events and take turns until `over`.

        While `busy`, a turn with `tick=True` comes about 60 times a second, late rather than twice. Otherwise the loop
        sleeps, and uses no processor, until an event or `wake_up`. Ctrl+C ends it with KeyboardInterrupt even then.
        """

    @abstractmethod
    def screen_size(self) -> tuple[int, int]:
        """Width and height of the screen in pixels."""

    # --- the program's side ---

    def loop(self) -> None:
        """Run until the program ends it, an exception has to be raised from here, or no window is left."""
        self.running = True
        self.ending = self.ending or not self.is_open
        try:
            if not self.over:
                self.run()
        finally:
            self.running = self.ending = False
            self._close_destroyed()
        self.raise_failure()

    def destroy(self, window: Window) -> None:
        """Close a window: at once if that is safe, otherwise at the end of the turn. Its hooks are silent then."""
        if window.is_open:
            window.is_open = False
            self.windows.remove(window)
            self._closing.append(window)
            if not self.running and not self.calling:
                self._close_destroyed()

    def close(self) -> None:
        """Close everything; a running loop ends."""
        for window in list(self.windows):
            self.destroy(window)
        self.is_open = False
        self.ending = True

    def wake(self) -> None:
        """Make a sleeping loop take a turn, which calls the wake hook. May be called from any thread."""
        self.woken.set()
        if self.is_open:
            self.wake_up()

    # --- the loop's side ---

    @property
    def over(self) -> bool:
        """Whether the loop has to end."""
        return self.ending or self.failure is not None or not self.windows

    @property
    def busy(self) -> bool:
        """Whether the loop has to tick; otherwise it sleeps until an event or a call of `wake_up`."""
        return "loop" in self.hooks or (self.autorepeat and any(each.keyboard.repeating for each in self.windows))

    def perform_actions(self) -> None:
        while self.actions:
            self.actions.popleft()()

    def turn(self, *, tick: bool) -> None:
        """Take one turn of the loop after its events, and draw changed windows. `tick`: call the loop hook, too."""
        for window in list(self.windows):
            self._deliver_pending(window)
        if self.woken.is_set():
            self.woken.clear()
            self.call(self.hooks, "wake")
        if tick and self.windows:
            self.call(self.hooks, "loop")
        self._close_destroyed()
        for window in self.windows:
            if window.visible and (window.stale or window.shown.changes):
                window.show()

    def lost(self) -> None:
        """Call the hook for the loss of the connection to the screen. The back end ends the program after it."""
        if "lost" in self.hooks:
            function, parameter = self.hooks["lost"]
            function(parameter)

    def _deliver_pending(self, window: Window) -> None:
        """Deliver the events that are merged to one a turn: first exposure, resize, key repeat."""
        if not window.announced:
            window.announced = True
            window.deliver(Event.MAP_NOTIFY)
            window.deliver(Event.EXPOSE)
        if window.resized:
            window.resized = False
            window.deliver(Event.CONFIGURE_NOTIFY)
            window.deliver("resize", window.width, window.height)
        if self.autorepeat:
            window.keyboard.repeat(self.time())

    def _close_destroyed(self) -> None:
        while self._closing:
            self._closing.pop().close()
