"""Writer of looping APNG films (PNG, Third Edition, W3C 2025)."""

from __future__ import annotations

import struct
from typing import BinaryIO

import numpy as np

from minirt.formats import png
from minirt.formats.films.changes import ONE_PIXEL, changed_rectangle
from minirt.formats.films.loop import LoopFilm

SECOND = 1000  # units of a delay


class ApngFilm(LoopFilm):
    """Writes pictures to a file, each as the rectangle that changes. The file can seek: it begins with their number."""

    longest = 2**16 - 1  # milliseconds

    def __init__(self, out: BinaryIO, fps: float, quality: int | None = None) -> None:
        super().__init__(out, fps, quality, round(SECOND / fps))
        self.before: np.ndarray | None = None
        self.pictures = self.numbered = 0  # pictures, and chunks that have a number
        self.counted_at = 0

    def add(self, picture: np.ndarray) -> None:
        """Write a picture, (h, w, 3) uint8."""
        changed = changed_rectangle(self.before, picture)
        if changed is None and self.stays():
            return
        changed = changed or ONE_PIXEL
        if self.before is None:
            self.out.write(png.SIGNATURE + png.chunk(b"IHDR", png.header(picture)))
            self.counted_at = self.out.tell()
            self.out.write(self.counts())
        place = changed.width, changed.height, changed.x, changed.y
        first, self.numbered = self.numbered, self.numbered + 1
        image = b"".join(map(self.data_chunk, png.image_data(changed.of(picture))))

        def packed(duration: int) -> bytes:
            return png.chunk(b"fcTL", struct.pack(">5I2H2B", first, *place, duration, SECOND, 0, 0)) + image

        self.follow(packed)
        self.before = picture
        self.pictures += 1

    def data_chunk(self, data: bytes) -> bytes:
        """Return a chunk of pixels, which has a number unless it belongs to the first picture."""
        if self.before is None:
            return png.chunk(b"IDAT", data)
        self.numbered += 1
        return png.chunk(b"fdAT", struct.pack(">I", self.numbered - 1) + data)

    def counts(self) -> bytes:
        """Return the chunk with the number of pictures, which are repeated for ever."""
        return png.chunk(b"acTL", struct.pack(">2I", self.pictures, 0))

    def end(self) -> None:
        """Write the last picture and the end of the file, and the number of pictures at its beginning."""
        self.follow(None)
        self.out.write(png.chunk(b"IEND", b""))
        self.out.seek(self.counted_at)
        self.out.write(self.counts())
