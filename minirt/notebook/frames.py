"""The stream of frames to the page: encoded as JPEG, and never more of them under way than the page can show."""

from __future__ import annotations

import io
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

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
