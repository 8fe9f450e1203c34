"""Writer of looping GIF films (GIF89a, CompuServe 1990). Pillow chooses the colours of pictures and compresses them."""

from __future__ import annotations

import io
import struct
from typing import BinaryIO

import numpy as np

from minirt.formats.films.changes import ONE_PIXEL, changed_rectangle
from minirt.formats.films.loop import LoopFilm

COLOURS = 255  # of each picture; the last index is left for pixels that stay as they are
UNCHANGED = 255
LOOP = b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00"  # for ever
KEEP, TRANSPARENT = 1 << 2, 1  # flags of a picture: it stays below the next one, and has a transparent index
LOCAL_TABLE = 0x80  # flag of a picture with a colour table of its own; its lowest bits tell the size
IMAGE, EXTENSION = 0x2C, 0x21  # first bytes of blocks


class GifFilm(LoopFilm):
    """Writes pictures to a file, each as the rectangle that changes."""

    longest = 2**16 - 1  # hundredths of a second

    def __init__(self, out: BinaryIO, fps: float, quality: int | None = None) -> None:
        super().__init__(out, fps, quality, max(2, round(100 / fps)))  # many programs slow down shorter pictures
        self.shown: np.ndarray | None = None  # the last picture, in its colours

    def add(self, picture: np.ndarray) -> None:
        """Write a picture, (h, w, 3) uint8."""
        indices, palette = quantised(picture)
        shown = palette[indices]
        if self.shown is None:
            self.out.write(b"GIF89a" + struct.pack("<HHBBB", picture.shape[1], picture.shape[0], 0, 0, 0) + LOOP)
        changed = changed_rectangle(self.shown, shown)
        if changed is None and self.stays():
            return
        changed = changed or ONE_PIXEL
        part = changed.of(indices).copy()
        if self.shown is not None:
            part[(changed.of(shown) == changed.of(self.shown)).all(axis=2)] = UNCHANGED
        table, transparent, data = compressed(part, palette)
        flags = KEEP if transparent is None else KEEP | TRANSPARENT
        size = LOCAL_TABLE | (len(table) // 3).bit_length() - 2
        image = struct.pack("<BBBHHHHB", transparent or 0, 0, IMAGE, *changed, size) + table + data
        self.follow(lambda duration: struct.pack("<BBBBH", EXTENSION, 0xF9, 4, flags, duration) + image)
        self.shown = shown

    def end(self) -> None:
        """Write the last picture and the end of the file."""
        self.follow(None)
        self.out.write(b";")


def quantised(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Reduce a picture to indices (h, w) of colours (256, 3), by an octree: it keeps the colours of small objects, and
    takes two thirds of the bytes of a median cut."""
    from PIL import Image as pillow  # noqa: N813

    reduced = pillow.fromarray(picture).quantize(COLOURS, pillow.Quantize.FASTOCTREE, dither=pillow.Dither.NONE)
    palette = np.zeros((256, 3), np.uint8)
    colours = np.array(reduced.getpalette(), np.uint8).reshape(-1, 3)
    palette[: len(colours)] = colours
    return np.asarray(reduced), palette


def compressed(indices: np.ndarray, palette: np.ndarray) -> tuple[bytes, int | None, bytes]:
    """Compress indices of colours by Pillow: return the table of those that are used, the index of unchanged pixels if
    there are any, and the compressed data."""
    from PIL import Image as pillow  # noqa: N813

    image = pillow.frombytes("P", indices.shape[::-1], indices.tobytes())
    image.putpalette(palette.tobytes())
    buffer = io.BytesIO()
    has_unchanged = bool((indices == UNCHANGED).any())
    image.save(buffer, "GIF", optimize=True, interlace=0, **({"transparency": UNCHANGED} if has_unchanged else {}))
    return parts_of(buffer.getvalue())


def parts_of(file: bytes) -> tuple[bytes, int | None, bytes]:
    """Return the colour table, the transparent index and the data of the only picture in a GIF file."""
    end = 13 + (3 * 2 ** ((file[10] & 7) + 1))
    table, at, transparent = file[13:end], end, None
    while file[at] == EXTENSION:
        if file[at + 1] == 0xF9 and file[at + 3] & TRANSPARENT:
            transparent = file[at + 6]
        at += 2
        while file[at]:
            at += 1 + file[at]
        at += 1
    return table, transparent, file[at + 10 : -1]
