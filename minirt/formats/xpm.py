"""Reader of XPM pictures: C source with strings that hold a header, colours, and rows of characters.

Textures and programs of MiniLibX use it. Colours are #RGB to #RRRRGGGGBBBB, or names of X11: red, Light Goldenrod,
SeaGreen3, grey50.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from itertools import islice
from typing import NamedTuple

import numpy as np

from minirt.helpers import package

COMMENT_OR_STRING = re.compile(rb'/\*.*?(?:\*/|\Z)|//[^\n]*+|"((?:[^"\\\n]++|\\.)*+)"', re.DOTALL)
HEADER = re.compile(rb"\s*+(\d{1,9})\s+(\d{1,9})\s+(\d{1,9})\s+(\d{1,9})\b.*", re.DOTALL)
HEX = re.compile(r"#((?:[0-9a-fA-F]{3}){1,4})")
KEYS = ("c", "g", "g4", "m", "s")  # colour, grey, four levels of grey, black and white, symbol; the best one first
MOST_COLOURS = 2**18
LONGEST = 8  # characters of a pixel
LONGEST_DEFINITION = 1000  # characters of a colour


class XpmError(ValueError):
    """An error in an XPM picture, and its place; it quotes nothing of the file."""


class XpmHeader(NamedTuple):
    """The header of an XPM picture."""

    width: int
    height: int
    colours: int
    length: int  # characters of a pixel


def strings_of(source: bytes) -> Iterator[bytes]:
    """Yield the strings of C source; comments are skipped."""
    for found in COMMENT_OR_STRING.finditer(source):
        if found[1] is not None:
            yield re.sub(rb"\\(.)", rb"\1", found[1], flags=re.DOTALL) if b"\\" in found[1] else found[1]


def read_header(strings: Iterator[bytes]) -> XpmHeader:
    """Read the first string of a picture; XpmError where it is no header."""
    text = next(strings, b"")
    match = HEADER.fullmatch(text)
    if not match:
        raise XpmError("the first string must be a header such as '16 16 2 1'")
    header = XpmHeader(*map(int, match.groups()))
    if not header.width or not header.height:
        raise XpmError(f"it has {header.width}x{header.height} pixels")
    if not 1 <= header.colours <= MOST_COLOURS:
        raise XpmError(f"it may have 1 to {MOST_COLOURS} colours")
    if not 1 <= header.length <= LONGEST:
        raise XpmError(f"a pixel may have 1 to {LONGEST} characters")
    return header


def read_pixels(strings: Iterator[bytes], header: XpmHeader) -> np.ndarray:
    """Return the pixels from the strings behind the header, uint8 (height, width, 4): blue, green, red, and alpha.

    Transparent pixels are 0, 0, 0, 0. XpmError.
    """
    width, height, count, length = header
    definitions = list(islice(strings, count))
    if len(definitions) < count:
        raise XpmError(f"it has {len(definitions)} of {count} colours")
    colours = {line[:length]: colour(line[length:], number) for number, line in enumerate(definitions, 1)}
    words = np.empty((height, width), "<u4")
    number = 0  # of the last row that was read
    for number, row in enumerate(islice(strings, height), 1):
        try:
            words[number - 1] = [colours[row[at : at + length]] for at in range(0, width * length, length)]
        except KeyError as error:
            at = next(at for at in range(0, width * length, length) if row[at : at + length] == error.args[0])
            raise XpmError(f"row {number}, column {at + 1}: expected one of the colours of the picture") from None
    if number < height:
        raise XpmError(f"it has {number} of {height} rows")
    return words.view(np.uint8).reshape(height, width, 4)


def colour(definition: bytes, number: int) -> int:
    """Return the colour 0xAARRGGBB of a definition such as ` c #FF8000 m white s roof`.

    XpmError for one without a colour, with the `number` of the definition.
    """
    values: dict[str, str] = {}  # by the keys before them
    key = ""  # the last key: the words behind it are its value
    for word in definition[:LONGEST_DEFINITION].decode("latin-1").split():
        # A key is a value, too, where one is missing: `c g` is a colour named g.
        if word in KEYS and (not key or key in values):
            key = word
        elif key:
            values[key] = f"{values.get(key, '')}{word}"
    value = next((values[key] for key in KEYS if key in values), "")
    if match := HEX.fullmatch(value):
        digits = len(match[1]) // 3
        most = int(16**digits) - 1
        levels = (int(match[1][at : at + digits], 16) for at in range(0, 3 * digits, digits))
        red, green, blue = ((510 * level + most) // (2 * most) for level in levels)  # 255 * level / most, rounded
        return 0xFF000000 | red << 16 | green << 8 | blue
    name = value.lower().replace("grey", "gray")
    if name in ("none", "transparent"):
        return 0  # transparent
    if name not in names():
        raise XpmError(f"colour {number} must be one such as 'c #FF8000', 'c red' or 'c None'")
    return 0xFF000000 | names()[name]


@cache
def names() -> dict[str, int]:
    """The colours 0xRRGGBB of X11 and CSS by their names, in lower case without spaces; X11's where both have one."""
    lines = package.read(__name__, "x11_colours.txt").decode().splitlines()
    return {name: int(colour, 16) for colour, name in map(str.split, lines)}
