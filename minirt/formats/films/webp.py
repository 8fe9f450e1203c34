"""Writer of looping WebP films (RFC 9649). Pillow compresses each picture."""

from __future__ import annotations

import io
import struct
from typing import BinaryIO

import numpy as np

from minirt.formats.films.changes import ONE_PIXEL, changed_rectangle
from minirt.formats.films.loop import LoopFilm

QUALITY = 80  # of 100
METHOD = 0  # of compression: the fastest
ANIMATION = 0x02  # flag of the file
REPLACES = 0x02  # flag of a picture: it is not blended with the one below
HEAD = 12  # bytes of a file before its chunks
EVEN = 2  # pixels: places of rectangles are multiples


class WebpFilm(LoopFilm):
    """Writes pictures to a file, each as the rectangle that changes. The file can seek: it begins with its size."""

    longest = 2**24 - 1  # milliseconds

    def __init__(self, out: BinaryIO, fps: float, quality: int | None = None) -> None:
        super().__init__(out, fps, quality, round(1000 / fps))
        self.level = QUALITY if quality is None else quality
        self.before: np.ndarray | None = None

    def add(self, picture: np.ndarray) -> None:
        """Write a picture, (h, w, 3) uint8."""
        if self.before is None:
            size = three_bytes(picture.shape[1] - 1) + three_bytes(picture.shape[0] - 1)
            self.out.write(b"RIFF\0\0\0\0WEBP")
            self.out.write(chunk(b"VP8X", struct.pack("<I", ANIMATION) + size))
            self.out.write(chunk(b"ANIM", b"\0\0\0\xff" + struct.pack("<H", 0)))
        changed = changed_rectangle(self.before, picture, EVEN)
        if changed is None and self.stays():
            return
        changed = changed or ONE_PIXEL
        place = changed.x // EVEN, changed.y // EVEN, changed.width - 1, changed.height - 1
        head, image = b"".join(map(three_bytes, place)), compressed(changed.of(picture), self.level)
        self.follow(lambda duration: chunk(b"ANMF", head + three_bytes(duration) + bytes([REPLACES]) + image))
        self.before = picture

    def end(self) -> None:
        """Write the last picture, and the size of the file at its beginning."""
        self.follow(None)
        size = self.out.tell()
        self.out.seek(4)
        self.out.write(struct.pack("<I", size - 8))


def three_bytes(number: int) -> bytes:
    """Return a number below 2^24, the lowest byte first."""
    return number.to_bytes(3, "little")


def chunk(kind: bytes, data: bytes) -> bytes:
    """Return a chunk of the file: kind, length, data and what makes it even."""
    return kind + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def compressed(picture: np.ndarray, quality: int) -> bytes:
    """Return the chunks of a picture."""
    from PIL import Image as pillow  # noqa: N813

    buffer = io.BytesIO()
    pillow.fromarray(picture).save(buffer, "WEBP", quality=quality, method=METHOD)
    return buffer.getvalue()[HEAD:]
