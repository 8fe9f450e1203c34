"""Writer of TIFF pictures of 8 or 16 bits, or of float32 (TIFF 6.0; compressed by Deflate): whole, or strip by strip.

The directory, at the end, has the places of the strips. BigTIFF has places of 64 bits, so many more pixels than fit
into memory.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterable, Sequence
from typing import BinaryIO

import numpy as np

SHORT, LONG, RATIONAL, LONG8 = 3, 4, 5, 16  # types of values
CODES = {SHORT: "H", LONG: "I", RATIONAL: "I", LONG8: "Q"}
ROWS = 16  # of a strip: those of a row of tiles
DEFLATE, DIFFERENCES = 8, 2  # compression, and predictor: each pixel less the one before
FLOAT, PLAIN, WHOLE, REAL = 32, 1, 1, 3  # bits of float32, the predictor of its pixels, and formats of samples
LEVEL, FAST = 6, 2  # of zlib: of 1 to 9; the fast one takes no longer than rendering


def encode(levels: np.ndarray) -> bytes:
    """Return the file of levels, (h, w, 3) uint8 or uint16, or of light, float32."""
    buffer, (height, width) = io.BytesIO(), levels.shape[:2]
    write(buffer, width, height, 8 * levels.itemsize, strips(levels, LEVEL), is_big=False)
    return buffer.getvalue()


def write(file: BinaryIO, width: int, height: int, bits: int, strips: Iterable[bytes], is_big: bool = True) -> None:
    """Write a picture of strips, the upper one first, to a file that can seek."""
    file.write(header(0, is_big))
    places, sizes = [], []
    for each in strips:
        places.append(file.tell())
        sizes.append(file.write(each))
    end = file.tell() + file.tell() % 2
    file.seek(end)
    file.write(directory(width, height, bits, places, sizes, end, is_big))
    file.seek(0)
    file.write(header(end, is_big))


def header(place: int, is_big: bool) -> bytes:
    """Return the order of bytes, the version, for BigTIFF how long places are, and the place of the directory."""
    return struct.pack("<2sHHHQ", b"II", 43, 8, 0, place) if is_big else struct.pack("<2sHI", b"II", 42, place)


def strips(levels: np.ndarray, level: int = FAST) -> tuple[bytes, ...]:
    """Return the compressed strips of some rows, (h, w, 3) uint8, uint16 or float32."""
    numbers = levels.astype(levels.dtype.newbyteorder("<"))
    if levels.dtype.kind == "u":
        numbers[:, 1:] -= levels[:, :-1]
    return tuple(zlib.compress(numbers[top : top + ROWS].data, level) for top in range(0, len(levels), ROWS))


def directory(
    width: int, height: int, bits: int, places: Sequence[int], sizes: Sequence[int], start: int, is_big: bool
) -> bytes:
    """Return the directory that begins at byte `start` of a file with strips at these places, of these sizes in bytes.

    A channel of a pixel has so many `bits`. In a big file, a BigTIFF, places and sizes have 64 bits. Values that do not
    fit into an entry follow behind all entries.
    """
    count_code, word, kind_of_place = ("Q", "Q", LONG8) if is_big else ("H", "I", LONG)
    entries: list[tuple[int, int, Sequence[int]]] = [  # tags, types and values
        (256, LONG, [width]),
        (257, LONG, [height]),
        (258, SHORT, [bits] * 3),
        (259, SHORT, [DEFLATE]),
        (262, SHORT, [2]),  # RGB
        (273, kind_of_place, places),
        (277, SHORT, [3]),  # channels of a pixel
        (278, LONG, [ROWS]),
        (279, kind_of_place, sizes),
        (282, RATIONAL, [72, 1]),  # pixels per inch across, and down
        (283, RATIONAL, [72, 1]),
        (284, SHORT, [1]),  # the channels of a pixel side by side
        (296, SHORT, [2]),  # the inch
        (317, SHORT, [PLAIN if bits == FLOAT else DIFFERENCES]),
        (339, SHORT, [REAL if bits == FLOAT else WHOLE] * 3),
    ]
    short = struct.calcsize(word)  # bytes of values that stand in the entry itself
    out, behind = struct.pack(f"<{count_code}", len(entries)), b""
    place = start + len(out) + (4 + 2 * short) * len(entries) + short  # of what is behind
    for tag, kind, values in entries:
        data = struct.pack(f"<{len(values)}{CODES[kind]}", *values)
        if len(data) > short:
            data, behind = struct.pack(f"<{word}", place + len(behind)), behind + data
        count = len(values) // 2 if kind == RATIONAL else len(values)
        out += struct.pack(f"<HH{word}", tag, kind, count) + data.ljust(short, b"\0")
    no_further_directory = struct.pack(f"<{word}", 0)
    return out + no_further_directory + behind
