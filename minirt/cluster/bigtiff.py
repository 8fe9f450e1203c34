"""Writer of BigTIFF files strip by strip, in any order (TIFF 6.0 with places of 64 bits; compressed by Deflate).

Strips stand in the file in the order in which they come; the directory, at the end, has their places. A file may have
2^64 bytes, so many more pixels than fit into memory.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence

import numpy as np

from minirt.kernel.stored_light import TILE

SHORT, LONG, LONG8 = 3, 4, 16  # types of values
CODES = {SHORT: "H", LONG: "I", LONG8: "Q"}
ROWS = TILE  # of a strip: bands begin with a row of tiles
DEFLATE, DIFFERENCES = 8, 2  # compression, and predictor: each pixel less the one before
LEVEL = 2  # of zlib: of 1 to 9, so that compressing takes no longer than rendering
HEADER = struct.Struct("<2sHHHQ")  # byte order, version, bytes of a place, 0, place of the directory


def strips(levels: np.ndarray) -> tuple[bytes, ...]:
    """Return the compressed strips of some rows, (h, w, 3) uint8 or uint16."""
    return tuple(strip(levels[top : top + ROWS]) for top in range(0, len(levels), ROWS))


def strip(levels: np.ndarray) -> bytes:
    """Return a compressed strip."""
    differences = levels.astype(levels.dtype.newbyteorder("<"))
    differences[:, 1:] -= levels[:, :-1]
    return zlib.compress(differences.data, LEVEL)


def header(directory: int = 0) -> bytes:
    """Return the header of a file whose directory begins at a byte; 0 while it has none."""
    return HEADER.pack(b"II", 43, 8, 0, directory)


def directory(width: int, height: int, bits: int, places: Sequence[int], sizes: Sequence[int], start: int) -> bytes:
    """Return the directory that begins at byte `start` of a file with strips of these places and sizes."""
    entries: list[tuple[int, int, Sequence[int]]] = [
        (256, LONG, [width]),
        (257, LONG, [height]),
        (258, SHORT, [bits] * 3),
        (259, SHORT, [DEFLATE]),
        (262, SHORT, [2]),  # RGB
        (273, LONG8, places),
        (277, SHORT, [3]),
        (278, LONG, [ROWS]),
        (279, LONG8, sizes),
        (284, SHORT, [1]),  # the channels of a pixel side by side
        (317, SHORT, [DIFFERENCES]),
    ]
    out, behind = struct.pack("<Q", len(entries)), b""
    place = start + 8 + 20 * len(entries) + 8
    for tag, kind, values in entries:
        data = struct.pack(f"<{len(values)}{CODES[kind]}", *values)
        if len(data) > 8:
            data, behind = struct.pack("<Q", place + len(behind)), behind + data
        out += struct.pack("<HHQ", tag, kind, len(values)) + data.ljust(8, b"\0")
    return out + struct.pack("<Q", 0) + behind
