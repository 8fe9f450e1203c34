"""Reader of XPM pictures: C source whose strings hold a header, the colours, and the rows as characters.

It reads what Pillow reads, and looks up all pixels of some rows at once: Pillow takes 0.2 to 2 us a pixel.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np

MAGIC = b"/* XPM */"
STRING = re.compile(rb'"([^"\n]*+)"')
HEADER = re.compile(rb"\s*+(\d{1,9})\s+(\d{1,9})\s+(\d{1,9})\s+(\d{1,9})\b.*")
COLOUR = re.compile(rb"#((?:[0-9a-fA-F]{3}){1,4})")
MOST_COLOURS = 2**18
LONGEST = 8  # characters of a pixel
LONGEST_DEFINITION = 1000  # characters of a colour
BAND = 2**20  # pixels that are looked up at once


class XpmError(ValueError):
    """An error in an XPM picture."""


class Header(NamedTuple):
    """The header of an XPM picture."""

    width: int
    height: int
    colours: int
    length: int  # characters of a pixel


def strings_of(data: bytes) -> Iterator[bytes]:
    """Yield the strings of a file."""
    return (found[1] for found in STRING.finditer(data))


def read_header(strings: Iterator[bytes]) -> Header:
    """Read the first string of a file; XpmError where it is no header."""
    text = next(strings, b"")
    match = HEADER.fullmatch(text)
    if not match:
        raise XpmError(f"expected a header such as '16 16 2 1', got {shown(text)}")
    header = Header(*map(int, match.groups()))
    if not 1 <= header.colours <= MOST_COLOURS:
        raise XpmError(f"it has {header.colours} colours, and may have 1 to {MOST_COLOURS}")
    if not 1 <= header.length <= LONGEST:
        raise XpmError(f"a pixel has {header.length} characters, and may have 1 to {LONGEST}")
    return header


def read_pixels(strings: Iterator[bytes], header: Header) -> np.ndarray:
    """Return the colours of the pixels, uint8 (height, width, 3), from the strings behind the header; XpmError.

    Transparent pixels are black.
    """
    width, height, count, length = header
    lines = list(islice(strings, count))
    if len(lines) < count:
        raise XpmError(f"it has {len(lines)} colours of {count}")
    known = {line[:length]: colour(line[length:]) for line in lines}
    keys = codes_of(b"".join(known), length)
    order = np.argsort(keys)
    keys, colours = keys[order], np.array(list(known.values()), np.uint8)[order]
    pixels = np.empty((height, width, 3), np.uint8)
    band = max(1, BAND // width)
    for start in range(0, height, band):
        rows = list(islice(strings, min(band, height - start)))
        check_rows(rows, start, header)
        codes = codes_of(b"".join(rows), length)
        places = np.searchsorted(keys[:-1], codes) if length > 2 else places_of(keys)[codes]
        unknown = keys[places] != codes
        if unknown.any():
            at = int(unknown.argmax())
            row, column = divmod(at, width)
            text = rows[row][column * length : (column + 1) * length]
            raise XpmError(f"row {start + row + 1}: {shown(text)} is no colour")
        colours.take(places, axis=0, out=pixels[start : start + band].reshape(-1, 3), mode="clip")
    return pixels


def check_rows(rows: list[bytes], start: int, header: Header) -> None:
    """Check that rows from row `start` on are there and have the length that the header says; XpmError."""
    for number, row in enumerate(rows, start + 1):
        if len(row) != header.width * header.length:
            raise XpmError(f"row {number} has {len(row)} characters, and should have {header.width * header.length}")
    if start + len(rows) < header.height and len(rows) < max(1, BAND // header.width):
        raise XpmError(f"it has {start + len(rows)} rows of {header.height}")


def codes_of(text: bytes, length: int) -> np.ndarray:
    """Return the characters of each pixel as a whole number."""
    codes: np.ndarray = np.zeros(len(text) // length, np.uint64 if length > 2 else np.uint16)
    for place, column in enumerate(np.frombuffer(text, np.uint8).reshape(-1, length).T):
        codes += column.astype(codes.dtype) << codes.dtype.type(8 * place)
    return codes


def places_of(keys: np.ndarray) -> np.ndarray:
    """Return, for each number of 16 bits, its place among sorted keys; 0 where it is none of them."""
    places = np.zeros(2**16, np.intp)
    places[keys] = np.arange(len(keys))
    return places


def colour(definition: bytes) -> tuple[int, int, int]:
    """Return red, green and blue of a definition such as ` s roof c #FF8000`; XpmError."""
    words = definition[:LONGEST_DEFINITION].split()
    value = dict(zip(words[::2], words[1::2], strict=False)).get(b"c", b"")
    if value.lower() == b"none":
        return 0, 0, 0
    match = COLOUR.fullmatch(value)
    if not match:
        raise XpmError(f"expected a colour such as 'c #FF8000' or 'c None', got {shown(definition)}")
    digits = len(match[1]) // 3
    most = 16**digits - 1
    red, green, blue = (int(match[1][at * digits : (at + 1) * digits], 16) for at in range(3))
    return (510 * red + most) // (2 * most), (510 * green + most) // (2 * most), (510 * blue + most) // (2 * most)


def shown(text: bytes) -> str:
    """Return a part of a file for a message."""
    return repr(text.strip()[:40].decode("ascii", "replace"))
