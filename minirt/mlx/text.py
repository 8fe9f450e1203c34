"""Draw text into BGRA pixels with Pillow's built-in font, which gives the same pixels on every platform.

    draw_text(pixels, 10, 10, "hello", 0xFFFFFF, size=16, background=0x80000000)

The font has the letters of ASCII alone: accents are drawn as strokes above small letters, and left out on capitals.
Rendered words are cached, independent of position and colour: in a line that changes most of them stay.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minirt.mlx.canvas import OPAQUE, blend

SIZE = 16  # pixels
ACCENT_INK = 230  # of 255: strokes have hard edges, and look as dark as letters a little below full coverage
STROKE_THINNESS = 12  # the text's size by the width of a stroke
# Strokes of accents, as parts of the text's size: right of the letter's middle, and above the baseline.
STROKES = {
    "\u0300": (((-0.13, 0.74), (0.07, 0.61)),),  # grave
    "\u0301": (((0.13, 0.74), (-0.07, 0.61)),),  # acute
    "\u0302": (((-0.14, 0.61), (0.0, 0.74), (0.14, 0.61)),),  # circumflex
    "\u0308": (((-0.12, 0.72), (-0.12, 0.64)), ((0.12, 0.72), (0.12, 0.64))),  # diaeresis
    "\u0327": (((0.03, 0.0), (0.03, -0.08), (-0.07, -0.16)),),  # cedilla
}
LIGATURES = {"œ": "oe", "Œ": "OE", "«": '"', "»": '"', "\u2019": "'", "\u00a0": " ", "\u202f": " "}


def draw_text(
    pixels: NDArray[np.uint8],
    x: int,
    y: int,
    text: str,
    color: int,
    *,
    size: int = SIZE,
    pitch: int = 0,
    background: int | None = None,
    padding: int = 0,
) -> tuple[int, int]:
    """Draw opaque text with its top left corner at pixel x, y; return the width and height of the text in pixels.

    text: newlines start lines. color: 0xRRGGBB. size: of the font, in pixels.
    pitch: width of each character in pixels, as of a typewriter; 0 is the font's own.
    pixels: (h, w, 4) uint8, BGRA, written in place and opaque there; text outside is clipped.
    background: 0xAARRGGBB, blended by its alpha below the text and `padding` pixels around it.
    """
    width, height = measure(text, size, pitch)
    if background is not None:
        opacity = np.full((height + 2 * padding, width + 2 * padding), background & OPAQUE, np.uint32)
        _blend(pixels, x - padding, y - padding, opacity, background)
    for number, line in enumerate(text.split("\n")):
        _blend(pixels, x, y + number * _line_height(size), _coverage(line, size, pitch), color)
    return width, height


def measure(text: str, size: int = SIZE, pitch: int = 0) -> tuple[int, int]:
    """Return the width and height in pixels that `draw_text` would take."""
    lines = text.split("\n")
    return max(_width(line, size, pitch) for line in lines), len(lines) * _line_height(size)


def _blend(pixels: NDArray[np.uint8], x: int, y: int, coverage: NDArray[np.uint32], color: int) -> None:
    """Blend a colour into the pixels at x, y by its coverage, 0 to 255 in the bits of alpha, clipped at the borders."""
    height, width = pixels.shape[:2]
    left, top = max(0, -x), max(0, -y)
    ink = coverage[top : max(0, height - y), left : max(0, width - x)] | np.uint32(color & 0xFFFFFF)
    below = pixels.view("<u4")[y + top : y + top + ink.shape[0], x + left : x + left + ink.shape[1], 0]
    if ink.size:
        blend(below, ink)


@lru_cache(maxsize=1024)
def _coverage(line: str, size: int, pitch: int) -> NDArray[np.uint32]:
    """Coverage of each pixel by one line of text: (h, w), 0 to 255 in the bits of alpha, read-only.

    The words of a line are cached by themselves. Without a `pitch` the width is the font's own.
    """
    from PIL import Image, ImageDraw

    parts = _parts(line, pitch)
    if len(parts) > 1:
        return np.hstack([_coverage(part, size, pitch) for part in parts])
    line, accents = _without_accents(line)
    natural, height = _font(size).getlength(line), _line_height(size)
    width = pitch or int(np.ceil(natural))  # of one character, or of a line without a pitch
    if width == 0 or not line:
        return np.zeros((height, 0), np.uint32)
    image = Image.new("L", (max(width, int(np.ceil(natural))), height))
    start = (image.width - natural) / 2 if pitch else 0  # a single character is centred in its pitch
    baseline, _ = _font(size).getmetrics()
    draw = ImageDraw.Draw(image)
    draw.text((start, 0), line, fill=255, font=_font(size))
    for index, accent in accents:
        middle = start + (_font(size).getlength(line[:index]) + _font(size).getlength(line[: index + 1])) / 2
        for stroke in STROKES[accent]:
            points = [(middle + x * size, baseline - y * size) for x, y in stroke]
            draw.line(points, fill=ACCENT_INK, width=max(1, round(size / STROKE_THINNESS)))
    if image.width > width:  # narrow a wide character to the pitch
        image = image.resize((width, height), Image.Resampling.BILINEAR)
    coverage = np.asarray(image).astype(np.uint32) << np.uint32(24)
    coverage.flags.writeable = False
    return coverage


@lru_cache(maxsize=1024)
def _width(line: str, size: int, pitch: int) -> int:
    """Width of one line in pixels; six times as fast as drawing it."""
    parts = _parts(line, pitch)
    if len(parts) > 1:
        return sum(_width(part, size, pitch) for part in parts)
    return pitch or int(np.ceil(_font(size).getlength(_without_accents(line)[0]))) if line else 0


def _parts(line: str, pitch: int) -> list[str]:
    """Return what is drawn as a whole: words and the blanks between them, or with a pitch each character."""
    return list(line) if pitch else re.findall(" +|[^ ]+", line)


def _without_accents(line: str) -> tuple[str, list[tuple[int, str]]]:
    """Return a line of letters that the font has, and the accents of small letters with the index of the letter."""
    if line.isascii():
        return line, []
    from unicodedata import normalize

    letters, accents = "", []
    for character in line:
        letter, *marks = list(LIGATURES.get(character) or normalize("NFD", character))
        letters += letter
        accents += [(len(letters) - 1, mark) for mark in marks if mark in STROKES and letter.islower()]
        letters += "".join(mark for mark in marks if mark.isascii())
    return letters, accents


def _line_height(size: int) -> int:
    return int(sum(_font(size).getmetrics()))


@lru_cache(maxsize=64)
def _font(size: int) -> Any:
    from PIL import ImageFont

    return ImageFont.load_default(size)
