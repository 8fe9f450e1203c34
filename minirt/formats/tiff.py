"""Writer of TIFF pictures with 16 bits a channel, which Pillow lacks (TIFF 6.0; compressed by Deflate)."""

from __future__ import annotations

import struct
import zlib

import numpy as np

SHORT, LONG, RATIONAL = 3, 4, 5  # types of values
ROWS = 64  # of a strip
DEFLATE, DIFFERENCES = 8, 2  # compression, and predictor: each pixel less the one before
LEVEL = 6


def encode(levels: np.ndarray) -> bytes:
    """Return the file of levels, (h, w, 3) uint16."""
    height, width = levels.shape[:2]
    strips = [strip(levels[top : top + ROWS]) for top in range(0, height, ROWS)]
    offsets = 8 + np.cumsum([0, *map(len, strips)])
    end = int(offsets[-1]) + int(offsets[-1]) % 2  # the directory begins at an even place
    entries: list[tuple[int, int, list[int]]] = [
        (256, LONG, [width]),
        (257, LONG, [height]),
        (258, SHORT, [16, 16, 16]),
        (259, SHORT, [DEFLATE]),
        (262, SHORT, [2]),  # RGB
        (273, LONG, offsets[:-1].tolist()),
        (277, SHORT, [3]),
        (278, LONG, [ROWS]),
        (279, LONG, [len(each) for each in strips]),
        (282, RATIONAL, [72, 1]),  # pixels per inch
        (283, RATIONAL, [72, 1]),
        (284, SHORT, [1]),  # the channels of a pixel side by side
        (296, SHORT, [2]),
        (317, SHORT, [DIFFERENCES]),
    ]
    data = b"".join(strips).ljust(end - 8, b"\0")
    return struct.pack("<2sHI", b"II", 42, end) + data + directory(entries, end)


def strip(levels: np.ndarray) -> bytes:
    """Return some rows, compressed."""
    differences = levels.copy()
    differences[:, 1:] -= levels[:, :-1]
    return zlib.compress(differences.astype("<u2").tobytes(), LEVEL)


def directory(entries: list[tuple[int, int, list[int]]], start: int) -> bytes:
    """Return the directory that begins at byte `start`; values of more than 4 bytes stand behind it."""
    out = struct.pack("<H", len(entries))
    behind, place = b"", start + 2 + 12 * len(entries) + 4
    for tag, kind, values in entries:
        data = struct.pack(f"<{len(values)}{'H' if kind == SHORT else 'I'}", *values)
        count = len(values) // 2 if kind == RATIONAL else len(values)
        if len(data) > 4:
            data, behind = struct.pack("<I", place + len(behind)), behind + data + b"\0" * (len(data) % 2)
        out += struct.pack("<HHI", tag, kind, count) + data.ljust(4, b"\0")
    return out + struct.pack("<I", 0) + behind
