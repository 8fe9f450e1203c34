"""PageBackend: one window in a page of a browser, which sends events and gets frames."""

from __future__ import annotations

import io
import threading
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from minirt.errors import MlxError
from minirt.mlx.backend import TICK, Backend

if TYPE_CHECKING:
    from minirt.mlx.backend import Display
    from minirt.mlx.window import Window


SCREEN = (3840, 2160)  # pixels: the largest window
Message = dict[str, Any]


class PageBackend(Backend):
    """A back end whose loop runs in a thread of its own. Any thread may call `do`, `acknowledge` and `restart`.

    send: sends a message, and bytes with it, to the page.
    """

    def __init__(self, send: Callable[[Message, bytes], object]) -> None:
        self._send = send
        self.frames = FrameStream(lambda number, data: send({"kind": "frame", "number": number}, data))
        self._actions: deque[Callable[[], object]] = deque()
        self._awake = threading.Event()
        self._next_tick = 0.0

    def do(self, action: Callable[[], object]) -> None:
        """Have the loop perform an action before its next turn."""
        self._actions.append(action)
        self._awake.set()

    def acknowledge(self, number: int) -> None:
        """Note that the page has shown a frame, and send the one that waited for it."""
        self.do(lambda: self.frames.acknowledge(number))

    def restart(self) -> None:
        """Send the frame again: a page shows the window anew."""
        self.do(self._restart)

    @property
    def window(self) -> Window | None:
        """The window, once it is open."""
        return self._display.windows[0] if self._display.windows else None

    def _restart(self) -> None:
        self.frames.restart()
        for window in self._display.windows:
            window.stale = True

    # --- the contract of a back end ---

    def open(self, display: Display) -> None:
        self._display = display

    def open_window(self, window: Window) -> None:
        if self.window:
            raise MlxError("a page of a notebook has one window")

    def show(self, window: Window) -> None:
        window.shown.take_changes()
        window.stale = not self.frames.offer(window.shown.pixels, self.time())

    def run(self) -> None:
        self._display.turn(tick=False)
        while not self._display.over:
            self._awake.wait(self._patience())
            self._awake.clear()
            while self._actions:
                self._actions.popleft()()
            self._display.turn(tick=self._is_tick_due())
            if window := self.window:
                self.frames.sharpen(window.shown.pixels, self.time())

    def wake(self) -> None:
        self._awake.set()

    def screen_size(self) -> tuple[int, int]:
        return SCREEN

    def set_fullscreen(self, window: Window, on: bool) -> None:
        """Let the page fill the screen; the window keeps its size, and the page stretches its frames."""
        self._send({"kind": "full screen", "on": on}, b"")

    def show_pointer(self, window: Window, on: bool) -> None:
        self._send({"kind": "pointer", "cursor": window.cursor.value if on else "none"}, b"")

    def set_cursor(self, window: Window) -> None:
        self.show_pointer(window, True)

    def set_clipboard(self, window: Window, text: str) -> None:
        super().set_clipboard(window, text)
        self._send({"kind": "copy", "text": text}, b"")

    def _patience(self) -> float | None:
        """Seconds until there is something to do without an event; None for ever."""
        now = self.time()
        waits = [self.frames.patience(now), max(0.0, self._next_tick - now) if self._display.busy else None]
        return min((each for each in waits if each is not None), default=None)

    def _is_tick_due(self) -> bool:
        now = self.time()
        if not self._display.busy or now < self._next_tick:
            return False
        self._next_tick = now + TICK
        return True


AHEAD = 2  # frames under way that the page has not shown yet
COARSE = 80  # quality while frames follow each other: 4 ms at 960x540
FINE = 95  # quality of the last one
FULL_COLOUR = 0  # Pillow's number for colour at the resolution of brightness
QUIET = 0.15  # seconds after which a frame was the last one


class FrameStream:
    """Sends frames by `send(number, data)`, and keeps account of those that the page has shown."""

    def __init__(self, send: Callable[[int, bytes], object]) -> None:
        self._send = send
        self._number = 0  # of the last frame that was sent
        self._shown = 0  # number of the last frame that the page has shown
        self._due: float | None = None  # when the frame in the page is replaced by a finer one

    def offer(self, pixels: NDArray[np.uint8], now: float) -> bool:
        """Send a frame, (h, w, 4) BGRA, unless too many are under way; return whether it was sent."""
        if self._number - self._shown >= AHEAD:
            return False
        self._put(encode(pixels, COARSE))
        self._due = now + QUIET
        return True

    def sharpen(self, pixels: NDArray[np.uint8], now: float) -> None:
        """Send the same frame in finer quality, if no other one has followed it for some time."""
        if self._due is not None and now >= self._due and self._number == self._shown:
            self._due = None
            self._put(encode(pixels, FINE))

    def patience(self, now: float) -> float | None:
        """Return the seconds until `sharpen` has something to do; None for ever."""
        return None if self._due is None or self._number != self._shown else max(0.0, self._due - now)

    def acknowledge(self, number: int) -> None:
        """Note that the page has shown a frame."""
        self._shown = max(self._shown, min(number, self._number))

    def restart(self) -> None:
        """Forget the frames under way: another page shows the stream now."""
        self._shown = self._number

    def _put(self, data: bytes) -> None:
        self._number += 1
        self._send(self._number, data)


def encode(pixels: NDArray[np.uint8], quality: int) -> bytes:
    """Return a frame as JPEG."""
    from PIL import Image

    height, width = pixels.shape[:2]
    picture = Image.frombuffer("RGB", (width, height), np.ascontiguousarray(pixels), "raw", "BGRX", 0, 1)
    buffer = io.BytesIO()
    options = {"subsampling": FULL_COLOUR} if quality >= FINE else {}
    picture.save(buffer, "JPEG", quality=quality, **options)
    return buffer.getvalue()
