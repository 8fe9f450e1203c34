"""Numbers in a scene file, read and written: decimal, in ASCII, and exact to the last bit of a float64."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable

from minirt.errors import FieldError, quoted

NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
WHOLE = re.compile(r"[+-]?[0-9]+")
LONGEST = 300  # characters: many more than `repr` writes, few enough for a whole number to fit into a float64
PLAIN = rf"[-+.0-9eE]{{1,{LONGEST}}}"  # among these `float` and `int` accept exactly those that match NUMBER and WHOLE


def number(text: str) -> float:
    """Parse a finite number; refuse nan, 1_000 and digits of other scripts, which `float` accepts."""
    if len(text) > LONGEST or not NUMBER.fullmatch(text):
        raise FieldError("must be a number, " + found(text))
    value = float(text)
    if not math.isfinite(value):
        raise FieldError(f"must be a number that a float64 can hold, got {quoted(text)}")
    return value + 0.0  # -0 becomes 0


def whole(text: str) -> int:
    """Parse a whole number."""
    if len(text) > LONGEST or not WHOLE.fullmatch(text):
        raise FieldError("must be a whole number, " + found(text))
    return int(text)


def numbers(texts: Iterable[str]) -> list[float]:
    """Parse many numbers that match PLAIN, several times as fast. ValueError if one is no number; one may be
    infinite."""
    return [float(text) + 0.0 for text in texts]  # -0 becomes 0


def wholes(texts: Iterable[str]) -> list[int]:
    """Parse many whole numbers that match PLAIN; ValueError if one is none."""
    return list(map(int, texts))


def found(text: str) -> str:
    """The part of a message that quotes a wrong number, with the reason if it cannot be seen."""
    if len(text) > LONGEST:
        return f"got {len(text)} characters: {quoted(text)}"
    foreign = next((character for character in text if not character.isascii()), "")
    return f"got {quoted(text)}" + (f": {code_point_name(foreign)} is not ASCII" if foreign else "")


def code_point_name(character: str) -> str:
    """A character as its code point and Unicode name."""
    return f"U+{ord(character):04X} {unicodedata.name(character, '')}".rstrip()


def spelled(value: float) -> str:
    """Format a number as the shortest decimal that reads back as the same float64, without a trailing `.0`."""
    return repr(float(value) + 0.0).removesuffix(".0")
