"""Reader of Radiance pictures (`.hdr`, `.pic`): light without a limit, as red, green, blue and a common exponent.

The format is that of Ward, Real Pixels (Graphics Gems II, 1991), with the encodings of the Radiance programs: pixels as
they are, runs of equal pixels (old), and runs of equal components of a scanline (new).
"""

from __future__ import annotations

import re
from io import BytesIO
from math import inf
from typing import NamedTuple

import numpy as np

FORMAT = b"32-bit_rle_rgbe"
RESOLUTION = re.compile(rb"([-+][XY]) ([0-9]{1,9}) ([-+][XY]) ([0-9]{1,9})")
LONGEST_HEADER = 2**16  # bytes
SHORTEST, LONGEST = 8, 2**15 - 1  # pixels of a scanline in the new encoding
BRIGHTEST = 2.0**127  # that a float32 holds
REPEAT = b"\1\1\1"  # begins a pixel that tells how often the one before it is repeated
MOST_REPEATS = 4  # in a row; the number in each counts 256 times as much as that in the one before


class RadianceError(ValueError):
    """An error in a Radiance picture, and its place; it quotes nothing of the file."""


class RadianceHeader(NamedTuple):
    """The header of a Radiance picture."""

    width: int
    height: int
    axes: tuple[bytes, bytes]  # from one scanline to the next, and along a scanline: -Y is downwards
    exposure: float  # by which the pixels were multiplied
    end: int  # byte at which the pixels begin


def read_header(data: bytes) -> RadianceHeader:
    """Return the header of a file; RadianceError where it begins with none, or with one of another format."""
    file, number, exposure = BytesIO(data[:LONGEST_HEADER]), 1, 1.0
    while (text := file.readline()).strip():
        key, _, value = text.partition(b"=")
        if key.strip() == b"FORMAT" and value.strip() != FORMAT:
            raise RadianceError(f"line {number}: the format must be {FORMAT.decode()}")
        if key.strip() == b"EXPOSURE":
            try:
                exposure *= float(value)
            except ValueError:
                exposure = 0.0
            if not 0 < exposure < inf:
                raise RadianceError(f"line {number}: the exposure, times those before it, must be a number > 0")
        number += 1
    if not text:
        raise RadianceError(f"line {number - 1}: the header has no end")
    match = RESOLUTION.fullmatch(file.readline().strip())
    if not match or match[1][1:] == match[3][1:]:  # both sizes along one axis
        raise RadianceError(f"line {number + 1}: expected a size such as -Y 512 +X 1024")
    sizes = {match[1][1:]: int(match[2]), match[3][1:]: int(match[4])}
    return RadianceHeader(sizes[b"X"], sizes[b"Y"], (match[1], match[3]), exposure, file.tell())


def read_pixels(data: bytes, header: RadianceHeader) -> np.ndarray:
    """Return the light of the pixels that follow a header, float32 (height, width, 3), the upper row first.

    RadianceError where a scanline is damaged.
    """
    by_columns = header.axes[0] in (b"+X", b"-X")
    count, length = (header.width, header.height) if by_columns else (header.height, header.width)
    rgbe = np.empty((count, length, 4), np.uint8)
    at = header.end
    for number in range(count):
        try:
            at = read_scanline(data, at, rgbe[number])
        except RadianceError as error:
            raise RadianceError(f"scanline {number + 1} of {count}, {error}") from None
    if by_columns:
        rgbe = rgbe.swapaxes(0, 1)
    rgbe = rgbe[:: 1 if b"-Y" in header.axes else -1, :: 1 if b"+X" in header.axes else -1]
    with np.errstate(over="ignore"):  # mantissas are fractions of 256, and an exponent of 128 is 2^0
        scale = np.minimum(np.ldexp(1.0 / header.exposure, np.arange(256) - 136), BRIGHTEST).astype(np.float32)
        scale[0] = 0.0  # black, whatever the mantissas are
        light: np.ndarray = rgbe[..., :3] * scale.take(rgbe[..., 3])[..., None]
    light[light > BRIGHTEST] = BRIGHTEST
    return light


def read_scanline(data: bytes, at: int, pixels: np.ndarray) -> int:
    """Read the scanline at byte `at` into pixels, (length, 4), and return the byte behind it; RadianceError."""
    length = len(pixels)
    mark = data[at : at + 4]
    if SHORTEST <= length <= LONGEST and len(mark) == 4 and mark[:2] == b"\2\2" and mark[2] < 128:
        if mark[2] << 8 | mark[3] != length:
            raise RadianceError(f"byte {at}: it should have {length} pixels, and has {mark[2] << 8 | mark[3]}")
        return read_components(data, at + 4, pixels)
    return read_whole_pixels(data, at, pixels)


def read_components(data: bytes, at: int, pixels: np.ndarray) -> int:
    """Read a scanline in the new encoding from byte `at` of a file on, and return the byte behind it.

    It fills `pixels`, uint8 (length, 4). All red comes first, then green, blue and exponents; a byte above 128 begins a
    run. RadianceError where the scanline is damaged.
    """
    length = len(pixels)
    for component in range(4):
        line = bytearray()
        while len(line) < length:
            if at >= len(data):
                raise RadianceError(f"byte {at}: the file ends")
            is_run = data[at] > 128
            size = data[at] - 128 if is_run else data[at]
            if not 0 < size <= length - len(line):
                raise RadianceError(f"byte {at}: {size} pixels, where {length - len(line)} of {length} are missing")
            part = data[at + 1 : at + 2] * size if is_run else data[at + 1 : at + 1 + size]
            if len(part) < size:
                raise RadianceError(f"byte {len(data)}: the file ends")
            line += part
            at += 2 if is_run else 1 + size
        pixels[:, component] = np.frombuffer(line, np.uint8)
    return at


def read_whole_pixels(data: bytes, at: int, pixels: np.ndarray) -> int:
    """Read a scanline of whole pixels from byte `at` of a file on, and return the byte behind it.

    It fills `pixels`, uint8 (length, 4). 1, 1, 1, n repeats the last pixel n times; the next one in a row repeats it
    256 n times, and so on. RadianceError where the scanline is damaged.
    """
    size = pixels.nbytes
    line, end = bytearray(data[at : at + size]), at + size
    if len(line) < size or REPEAT in line:  # few files have repeats
        line, end, repeats = bytearray(), at, 0
        while len(line) < size:
            pixel, count, missing = data[end : end + 4], 1, (size - len(line)) // 4
            if len(pixel) < 4:
                raise RadianceError(f"byte {len(data)}: the file ends")
            if pixel.startswith(REPEAT):
                if not line:
                    raise RadianceError(f"byte {end}: no pixel to repeat")
                pixel, count, repeats = bytes(line[-4:]), pixel[3] << 8 * repeats, repeats + 1
            else:
                repeats = 0
            if count > missing or repeats > MOST_REPEATS:
                raise RadianceError(f"byte {end}: {count} pixels, where {missing} of {len(pixels)} are missing")
            line += pixel * count
            end += 4
    pixels[:] = np.frombuffer(line, np.uint8).reshape(pixels.shape)
    return end
