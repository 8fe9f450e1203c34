"""Reader of Radiance pictures (`.hdr`, `.pic`): light without a limit, as red, green, blue and a common exponent.

The format is that of Ward, Real Pixels (Graphics Gems II, 1991), with the encodings of the Radiance programs: pixels as
they are, runs of equal pixels (old), and runs of equal components of a scanline (new).
"""

from __future__ import annotations

import re
from math import inf
from typing import NamedTuple

import numpy as np

from minirt.errors import quoted

FORMAT = b"32-bit_rle_rgbe"
RESOLUTION = re.compile(rb"([-+])([XY]) ([0-9]{1,9}) ([-+])([XY]) ([0-9]{1,9})")
LONGEST_HEADER = 2**16  # bytes
SHORTEST, LONGEST = 8, 2**15 - 1  # pixels of a scanline in the new encoding
BRIGHTEST = 2.0**127  # that a float32 holds
MOST_SHIFT = 24  # bits, by which the fourth of several repeats in a row is shifted


class RadianceError(ValueError):
    """An error in a Radiance picture, and its place."""


class Header(NamedTuple):
    """The header of a Radiance picture."""

    width: int
    height: int
    scanlines: tuple[int, int]  # how many, and of how many pixels
    by_columns: bool  # whether a scanline is a column
    down: bool  # whether the upper row comes first
    right: bool  # whether the left column comes first
    exposure: float  # by which the pixels were multiplied
    end: int  # byte at which the pixels begin


def read_header(data: bytes) -> Header:
    """Read the header of a file; RadianceError where it is not one."""
    start, number, exposure = 0, 1, 1.0
    while True:
        end = data.find(b"\n", start, LONGEST_HEADER)
        if end < 0:
            raise RadianceError(f"line {number}: the header has no end")
        text = data[start:end].strip()
        start, number = end + 1, number + 1
        if not text:
            break
        key, _, value = text.partition(b"=")
        if key.strip() == b"FORMAT" and value.strip() != FORMAT:
            raise RadianceError(f"line {number - 1}: the format must be {FORMAT.decode()}, got {shown(value)}")
        if key.strip() == b"EXPOSURE":
            exposure *= positive(value, number - 1)
            if not 0 < exposure < inf:
                size = "large" if exposure else "small"
                raise RadianceError(f"line {number - 1}: the product of all exposures is too {size}")
    end = data.find(b"\n", start, start + LONGEST_HEADER)
    match = RESOLUTION.fullmatch(data[start:end].strip()) if end >= 0 else None
    if not match or match[2] == match[5]:
        found = shown(data[start : start + LONGEST_HEADER])
        raise RadianceError(f"line {number}: expected a size such as -Y 512 +X 1024, got {found}")
    first, second = int(match[3]), int(match[6])
    by_columns = match[2] == b"X"
    width, height = (first, second) if by_columns else (second, first)
    signs = {match[2]: match[1], match[5]: match[4]}
    down, right = signs[b"Y"] == b"-", signs[b"X"] == b"+"
    return Header(width, height, (first, second), by_columns, down, right, exposure, end + 1)


def positive(text: bytes, line: int) -> float:
    """Read a finite number above 0."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0 < number < inf:
        raise RadianceError(f"line {line}: the exposure must be a number > 0, got {shown(text)}")
    return number


def shown(text: bytes) -> str:
    """Return the first line of a part of a header for a message."""
    return quoted(text.strip().partition(b"\n")[0].decode("ascii", "replace"))


def read_pixels(data: bytes, header: Header) -> np.ndarray:
    """Return the light of the pixels, float32 (height, width, 3), the upper row first; RadianceError."""
    count, length = header.scanlines
    rgbe = np.empty((count, length, 4), np.uint8)
    at = header.end
    for number in range(count):
        try:
            at = read_scanline(data, at, rgbe[number])
        except RadianceError as error:
            raise RadianceError(f"scanline {number + 1} of {count}, {error}") from None
    if header.by_columns:
        rgbe = rgbe.swapaxes(0, 1)
    rgbe = rgbe[:: 1 if header.down else -1, :: 1 if header.right else -1]
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
            raise RadianceError(f"byte {at}: it has {mark[2] << 8 | mark[3]} pixels, and should have {length}")
        return read_components(data, at + 4, pixels)
    return read_whole_pixels(data, at, pixels)


def read_components(data: bytes, at: int, pixels: np.ndarray) -> int:
    """Read a scanline in the new encoding: all red, green, blue, exponents; a byte above 128 begins a run."""
    length = len(pixels)
    for component in range(4):
        line = bytearray()
        while len(line) < length:
            if at >= len(data):
                raise RadianceError(f"byte {at}: the file ends")
            is_run, size = data[at] > 128, data[at] - 128 * (data[at] > 128)
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
    """Read a scanline of whole pixels; one of 1, 1, 1, n repeats the last one n times, the next 256 n times, and so
    on."""
    length = len(pixels)
    for window in (length, (2 + MOST_SHIFT // 8) * length):  # the longer one for repeats of no pixels
        flat = np.frombuffer(data[at : at + 4 * window], np.uint8)
        flat = flat[: len(flat) // 4 * 4].reshape(-1, 4)
        repeats = (flat[:, :3] == 1).all(axis=1)
        if repeats[:1].any():
            raise RadianceError(f"byte {at}: no pixel to repeat")
        places = np.arange(len(flat))
        sources = np.maximum.accumulate(np.where(repeats, 0, places))  # of the pixels that are repeated
        shifts = np.where(repeats, 8 * (places - sources - 1), 0)
        counts = np.where(repeats, flat[:, 3].astype(np.int64) << np.minimum(shifts, MOST_SHIFT + 8), 1)
        ends = np.cumsum(counts)
        over = np.flatnonzero((ends >= length) | (shifts > MOST_SHIFT))
        if not len(over):
            continue
        last = int(over[0])
        if ends[last] > length or shifts[last] > MOST_SHIFT:
            count, missing = int(flat[last, 3]) << int(shifts[last]), length - int(ends[last - 1])
            raise RadianceError(f"byte {at + 4 * last}: {count} pixels, where {missing} of {length} are missing")
        pixels[:] = np.repeat(flat[sources[: last + 1]], counts[: last + 1], axis=0)
        return at + 4 * (last + 1)
    raise RadianceError(f"byte {len(data)}: the file ends")
