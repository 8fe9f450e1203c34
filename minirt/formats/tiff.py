"""Writer of TIFF pictures of 8 or 16 bits (TIFF 6.0; compressed by Deflate): whole, or strip by strip.

The directory, at the end, has the places of the strips. BigTIFF has places of 64 bits, so many more pixels than fit
into memory.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterable, Sequence
from typing import BinaryIO, NamedTuple

import numpy as np

SHORT, LONG, RATIONAL, LONG8 = 3, 4, 5, 16  # types of values
CODES = {SHORT: "H", LONG: "I", RATIONAL: "I", LONG8: "Q"}
ROWS = 16  # of a strip: those of a row of tiles
DEFLATE, DIFFERENCES = 8, 2  # compression, and predictor: each pixel less the one before
LEVEL, FAST = 6, 2  # of zlib: of 1 to 9; the fast one takes no longer than rendering


class Layout(NamedTuple):
    """Number formats of a kind of TIFF file: classic TIFF or BigTIFF."""

    header: struct.Struct  # order of bytes, version, place of the directory; BigTIFF says how long places are
    version: tuple[int, ...]
    number: str  # code of the number of entries
    place: str  # code of a place in the file, and of the number of values of an entry
    places: int  # type of the strips' places and sizes


CLASSIC = Layout(struct.Struct("<2sHI"), (42,), "H", "I", LONG)
BIG = Layout(struct.Struct("<2sHHHQ"), (43, 8, 0), "Q", "Q", LONG8)


def encode(levels: np.ndarray) -> bytes:
    """Return the file of levels, (h, w, 3) uint8 or uint16."""
    buffer, (height, width) = io.BytesIO(), levels.shape[:2]
    write(buffer, width, height, 8 * levels.itemsize, strips(levels, LEVEL), CLASSIC)
    return buffer.getvalue()


def write(file: BinaryIO, width: int, height: int, bits: int, strips: Iterable[bytes], layout: Layout = BIG) -> None:
    """Write a picture of strips, the upper one first, to a file that can seek."""
    file.write(layout.header.pack(b"II", *layout.version, 0))
    places, sizes = [], []
    for each in strips:
        places.append(file.tell())
        sizes.append(file.write(each))
    end = file.tell() + file.tell() % 2
    file.seek(end)
    file.write(directory(width, height, bits, places, sizes, end, layout))
    file.seek(0)
    file.write(layout.header.pack(b"II", *layout.version, end))


def strips(levels: np.ndarray, level: int = FAST) -> tuple[bytes, ...]:
    """Return the compressed strips of some rows, (h, w, 3) uint8 or uint16."""
    differences = levels.astype(levels.dtype.newbyteorder("<"))
    differences[:, 1:] -= levels[:, :-1]
    return tuple(zlib.compress(differences[top : top + ROWS].data, level) for top in range(0, len(levels), ROWS))


def directory(
    width: int, height: int, bits: int, places: Sequence[int], sizes: Sequence[int], start: int, layout: Layout
) -> bytes:
    """Return the directory that begins at byte `start` of a file with strips of these places and sizes."""
    entries: list[tuple[int, int, Sequence[int]]] = [
        (256, LONG, [width]),
        (257, LONG, [height]),
        (258, SHORT, [bits] * 3),
        (259, SHORT, [DEFLATE]),
        (262, SHORT, [2]),  # RGB
        (273, layout.places, places),
        (277, SHORT, [3]),
        (278, LONG, [ROWS]),
        (279, layout.places, sizes),
        (282, RATIONAL, [72, 1]),  # pixels per inch
        (283, RATIONAL, [72, 1]),
        (284, SHORT, [1]),  # the channels of a pixel side by side
        (296, SHORT, [2]),
        (317, SHORT, [DIFFERENCES]),
    ]
    short = struct.calcsize(layout.place)  # bytes of values that stand in the entry itself
    out, behind = struct.pack(f"<{layout.number}", len(entries)), b""
    place = start + len(out) + (4 + 2 * short) * len(entries) + short
    for tag, kind, values in entries:
        data = struct.pack(f"<{len(values)}{CODES[kind]}", *values)
        if len(data) > short:
            data, behind = struct.pack(f"<{layout.place}", place + len(behind)), behind + data
        count = len(values) // 2 if kind == RATIONAL else len(values)
        out += struct.pack(f"<HH{layout.place}", tag, kind, count) + data.ljust(short, b"\0")
    return out + struct.pack(f"<{layout.place}", 0) + behind
