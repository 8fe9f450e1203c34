"""The contract of a back end: what opens windows and brings their canvases to a screen, and events to their hooks."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from minirt.mlx.display import Display
    from minirt.mlx.handles import Window


class Backend(ABC):
    """One display at a time. All methods but `wake` are called from the thread that called `open`.

    A back end reports events through the methods of `Display` (press, motion, resize, …) from inside `run`, and calls
    `Display.turn` once after the events that came together. It draws from `Window.shown` and writes nothing there.
    """

    @abstractmethod
    def open(self, display: Display) -> None:
        """Connect to the screen. Raises MlxError with the reason where there is none."""

    @abstractmethod
    def close(self) -> None:
        """Let everything go; all windows are closed before."""

    @abstractmethod
    def open_window(self, window: Window) -> None:
        """Show a new window; sets the size that a resizable one really got. Raises MlxError."""

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
        """From any thread: make `run` take a turn soon. Calls that come together may share one turn."""

    @abstractmethod
    def time(self) -> float:
        """Seconds from some moment on; never runs backwards."""

    @abstractmethod
    def screen_size(self) -> tuple[int, int]:
        """Width and height of the screen in pixels."""

    @abstractmethod
    def set_title(self, window: Window) -> None:
        """Show `window.title`."""

    @abstractmethod
    def set_fullscreen(self, window: Window, on: bool) -> None:
        """Cover the screen, or go back to the size before; the new size comes as a resize."""

    @abstractmethod
    def move_pointer(self, window: Window, x: int, y: int) -> None:
        """Put the pointer at x, y from the window's top left corner."""

    @abstractmethod
    def show_pointer(self, window: Window, on: bool) -> None:
        """Show or hide the pointer over the window."""

    @abstractmethod
    def clipboard(self, window: Window) -> str:
        """The text on the clipboard, or nothing."""

    @abstractmethod
    def set_clipboard(self, window: Window, text: str) -> None:
        """Put text on the clipboard."""
