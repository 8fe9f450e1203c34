"""Backend: the contract of a window system, which shows canvases on a screen and reports events to windows."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from minirt.mlx.window import Window

ADVICE = "-o FILE renders without one"  # the end of an error where no window can be opened


class Loop(Protocol):
    """The part of a display that its back end uses; `minirt.mlx.display.Display` describes it."""

    windows: list[Window]

    @property
    def running(self) -> bool: ...

    @property
    def over(self) -> bool: ...

    @property
    def busy(self) -> bool: ...

    @property
    def woken(self) -> bool: ...

    def turn(self, *, tick: bool) -> None: ...

    def fail(self, failure: BaseException) -> None: ...

    def raise_failure(self) -> None: ...

    def lost(self) -> None: ...


class Backend(ABC):
    """A window system for one display at a time. All methods but `wake` are called from the thread that called `open`.

    A back end reports events to `Window.on_…` and `Window.keyboard` from inside `run`, and calls `Display.turn` once
    after all events that came together. It draws from `Window.shown` and writes nothing there.
    """

    @abstractmethod
    def open(self, display: Loop) -> None:
        """Connect to the screen. Raises MlxError with the reason where there is none."""

    @abstractmethod
    def close(self) -> None:
        """Disconnect from the screen; all windows are closed before."""

    @abstractmethod
    def open_window(self, window: Window) -> None:
        """Show a new window, and set the size that a resizable window really got. Raises MlxError."""

    @abstractmethod
    def close_window(self, window: Window) -> None:
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

    @abstractmethod
    def time(self) -> float:
        """Seconds of a clock that never runs backwards."""

    @abstractmethod
    def screen_size(self) -> tuple[int, int]:
        """Width and height of the screen in pixels."""

    @abstractmethod
    def set_title(self, window: Window) -> None:
        """Show `window.title`."""

    @abstractmethod
    def set_fullscreen(self, window: Window, on: bool) -> None:
        """Cover the screen, or return to the size before; the new size is reported as a resize."""

    @abstractmethod
    def move_pointer(self, window: Window, x: int, y: int) -> None:
        """Move the pointer to x, y from the window's top left corner."""

    @abstractmethod
    def show_pointer(self, window: Window, on: bool) -> None:
        """Show or hide the pointer over the window."""

    @abstractmethod
    def set_cursor(self, window: Window) -> None:
        """Give the pointer the shape of `window.cursor`."""

    @abstractmethod
    def set_icons(self, window: Window) -> None:
        """Show one of `window.icons` where the desktop shows an icon of the window."""

    @abstractmethod
    def clipboard(self, window: Window) -> str:
        """The text on the clipboard, or an empty string."""

    @abstractmethod
    def set_clipboard(self, window: Window, text: str) -> None:
        """Put text on the clipboard."""
