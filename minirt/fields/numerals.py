"""How numbers are spelled in a scene file: decimal, in ASCII, and exact to the last bit of a float64."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable

from minirt.errors import FieldError, quoted

NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
WHOLE = re.compile(r"[+-]?[0-9]+")
LONGEST = 300  # characters; many more than `repr` writes, and few enough for a whole number to fit into a float64
PLAIN = rf"[-+.0-9eE]{{1,{LONGEST}}}"  # of these `float` and `int` accept just what matches NUMBER and WHOLE


def number(text: str) -> float:
    """A finite number; what `float` accepts beyond the format (nan, 1_000, digits of other scripts) is refused."""
    if len(text) > LONGEST or not NUMBER.fullmatch(text):
        raise FieldError("must be a number, " + found(text))
    value = float(text)
    if not math.isfinite(value):
        raise FieldError(f"must be a number that a float64 can hold, got {quoted(text)}")
    return value + 0.0  # -0 becomes 0


def whole(text: str) -> int:
    """A whole number."""
    if len(text) > LONGEST or not WHOLE.fullmatch(text):
        raise FieldError("must be a whole number, " + found(text))
    return int(text)


def numbers(texts: Iterable[str]) -> list[float]:
    """Many numbers that match PLAIN, several times as fast; ValueError where one is none. It may be infinite."""
    return [float(text) + 0.0 for text in texts]  # -0 becomes 0


def wholes(texts: Iterable[str]) -> list[int]:
    """Many whole numbers that match PLAIN; ValueError where one is none."""
    return list(map(int, texts))


def found(text: str) -> str:
    """What stands where a number should be, with the reason where the eye would not see it."""
    if len(text) > LONGEST:
        return f"got {len(text)} characters: {quoted(text)}"
    foreign = next((character for character in text if not character.isascii()), "")
    return f"got {quoted(text)}" + (f": {code_point_name(foreign)} is not ASCII" if foreign else "")


def code_point_name(character: str) -> str:
    """A character by its code point and name."""
    return f"U+{ord(character):04X} {unicodedata.name(character, '')}".rstrip()


def spelled(value: float) -> str:
    """The shortest decimal that reads back as the same float64, without a trailing `.0`."""
    return repr(float(value) + 0.0).removesuffix(".0")
