"""Reader of XPM pictures: C source with strings that hold a header, colours and rows of characters."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from minirt.errors import MlxError
from minirt.mlx.x11_colours import names

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

COMMENT_OR_STRING = re.compile(r'/\*.*?\*/|//[^\n]*|"((?:[^"\\]|\\.)*)"', re.DOTALL)
HEADER = re.compile(r"\s*(\d{1,5})\s+(\d{1,5})\s+(\d{1,7})\s+(\d{1,2})\b.*", re.DOTALL)
HEX = re.compile(r"#(?:[0-9a-fA-F]{3}){1,4}")
KEYS = ("c", "g", "g4", "m", "s")  # colour, grey, four levels of grey, black and white, symbol; the best one first
TRANSPARENT = 0


def strings_of(source: str) -> list[str]:
    """Return the strings of C source; comments are skipped."""
    return [re.sub(r"\\(.)", r"\1", found[1]) for found in COMMENT_OR_STRING.finditer(source) if found[1] is not None]


def read_xpm(lines: Sequence[str]) -> NDArray[np.uint8]:
    """Return the pixels of an XPM picture: (h, w, 4) uint8, BGRA. Raises MlxError.

    lines: the strings of the file. Transparent pixels are 0, 0, 0, 0.
    """
    header = HEADER.fullmatch(lines[0]) if lines else None
    if not header:
        raise MlxError("an XPM picture begins with its width, height, number of colours and characters per pixel")
    width, height, count, length = map(int, header.groups())
    if not (width and height and count and length):
        raise MlxError(f"an XPM picture cannot be of {width}x{height} pixels with {count} colours")
    if len(lines) < 1 + count + height:
        raise MlxError(f"{count} colours and {height} rows are announced, and {len(lines) - 1} strings follow")
    colours = {line[:length]: _colour(line[length:]) for line in lines[1 : 1 + count]}
    words = np.empty((height, width), "<u4")
    for row, line in enumerate(lines[1 + count : 1 + count + height]):
        try:
            words[row] = [colours[line[at : at + length]] for at in range(0, width * length, length)]
        except KeyError as error:
            raise MlxError(f"row {row + 1} has the characters {error}, which are no colour") from error
    return words.view(np.uint8).reshape(height, width, 4)


def _colour(definition: str) -> int:
    """Return the colour 0xAARRGGBB of a line such as ` c #FF8000 m white s roof`."""
    values: dict[str, str] = {}
    key = ""
    for word in definition.split():
        # A key is a value, too, where one is missing: `c g` is a colour named g.
        if word in KEYS and (not key or key in values):
            key = word
        elif key:
            values[key] = f"{values.get(key, '')}{word}"
    for key in KEYS[:-1]:
        if key in values:
            return _value(values[key])
    raise MlxError(f"no colour in the definition {definition.strip()!r}")


def _value(text: str) -> int:
    """Return 0xAARRGGBB of #RGB to #RRRRGGGGBBBB, of a name, or of None."""
    if HEX.fullmatch(text):
        digits = (len(text) - 1) // 3
        levels = [int(text[1 + at * digits :][:digits], 16) for at in range(3)]
        most = (1 << 4 * digits) - 1
        red, green, blue = ((2 * 255 * level + most) // (2 * most) for level in levels)
        return 0xFF000000 | red << 16 | green << 8 | blue
    name = text.lower()
    if name in ("none", "transparent"):
        return TRANSPARENT
    if name not in names():
        raise MlxError(f"unknown colour {text!r}")
    return 0xFF000000 | names()[name]
