"""Writer of TIFF pictures of 8 or 16 bits (TIFF 6.0; compressed by Deflate): whole, or strip by strip in any order.

Strips stand in the file in the order in which they come; the directory, at the end, has their places. BigTIFF has
places of 64 bits, so many more pixels than fit into memory.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from typing import NamedTuple

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
    data = strips(levels, LEVEL)
    sizes = [len(each) for each in data]
    places = [CLASSIC.header.size + sum(sizes[:number]) for number in range(len(sizes))]
    end = even(places[-1] + sizes[-1])
    height, width = levels.shape[:2]
    tail = directory(width, height, 8 * levels.itemsize, places, sizes, end, CLASSIC)
    return (header(end, CLASSIC) + b"".join(data)).ljust(end, b"\0") + tail


def strips(levels: np.ndarray, level: int = FAST) -> tuple[bytes, ...]:
    """Return the compressed strips of some rows, (h, w, 3) uint8 or uint16."""
    return tuple(strip(levels[top : top + ROWS], level) for top in range(0, len(levels), ROWS))


def strip(levels: np.ndarray, level: int) -> bytes:
    """Return a compressed strip."""
    differences = levels.astype(levels.dtype.newbyteorder("<"))
    differences[:, 1:] -= levels[:, :-1]
    return zlib.compress(differences.data, level)


def even(place: int) -> int:
    """Return the place at or behind another where another part may begin."""
    return place + place % 2


def header(start: int = 0, layout: Layout = BIG) -> bytes:
    """Return the header of a file whose directory begins at a byte; 0 while it has none."""
    return layout.header.pack(b"II", *layout.version, start)


def directory(
    width: int,
    height: int,
    bits: int,
    places: Sequence[int],
    sizes: Sequence[int],
    start: int,
    layout: Layout = BIG,
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
            data, behind = struct.pack(f"<{layout.place}", place + len(behind)), behind + data.ljust(even(len(data)))
        count = len(values) // 2 if kind == RATIONAL else len(values)
        out += struct.pack(f"<HH{layout.place}", tag, kind, count) + data.ljust(short, b"\0")
    return out + struct.pack(f"<{layout.place}", 0) + behind
