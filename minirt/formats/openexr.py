"""Writer of OpenEXR pictures: red, green and blue as float32, scanlines compressed by ZIP, 16 at a time.

After the file layout of openexr.com (version 2, one part): a header of attributes, a table of offsets, blocks of lines.
"""

from __future__ import annotations

import struct
import zlib

import numpy as np

MAGIC, VERSION = 20000630, 2
ZIP, LINES = 3, 16  # number of the compression, and scanlines of a block
FLOAT = 2  # type of a channel: float32
LEVEL = 4  # of compression: as OpenEXR itself


def encode(light: np.ndarray) -> bytes:
    """Return the file of light, (h, w, 3) in the order red, green, blue."""
    height, width = light.shape[:2]
    blocks = [block(top, planes_of(light[top : top + LINES])) for top in range(0, height, LINES)]
    header = header_of(width, height)
    first = len(header) + 8 * len(blocks)
    offsets = first + np.cumsum([0, *map(len, blocks)])[:-1]
    return b"".join([header, offsets.astype("<u8").tobytes(), *blocks])


def header_of(width: int, height: int) -> bytes:
    """Return the header, from the magic number to the end of the attributes."""
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", FLOAT, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = (
        ("channels", "chlist", channels),
        ("compression", "compression", bytes([ZIP])),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", b"\0"),  # the upper line first
        ("pixelAspectRatio", "float", struct.pack("<f", 1)),
        ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)),
    )
    parts = [
        name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(v)) + v for name, kind, v in attributes
    ]
    return struct.pack("<2i", MAGIC, VERSION) + b"".join(parts) + b"\0"


def planes_of(light: np.ndarray) -> np.ndarray:
    """Return scanlines (n, w, 3) as all of blue, all of green, all of red of each (n, 3, w), float32."""
    return light[..., ::-1].astype("<f4").transpose(0, 2, 1)


def block(top: int, planes: np.ndarray) -> bytes:
    """Return a block of scanlines, the first of which is line `top`.

    Bytes are sorted into those of even and odd places, then each is replaced by its difference to the one before.
    """
    raw = planes.tobytes()
    data = np.frombuffer(raw, np.uint8)
    data = np.concatenate([data[0::2], data[1::2]])
    data[1:] -= data[:-1] - np.uint8(128)  # numpy computes the right side first
    packed = zlib.compress(data.tobytes(), LEVEL)
    if len(packed) >= len(raw):  # a reader takes a block of full length as it is
        packed = raw
    return struct.pack("<2i", top, len(packed)) + packed
