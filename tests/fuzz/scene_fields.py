"""Fields of scene files as predicates, written from the format's description, and shared with no parser."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from tests.fuzz.scene_files import exists

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
WHOLE = re.compile(r"[+-]?\d+", re.ASCII)
LONGEST, FARTHEST = 300, 1e15

Test = Callable[[str], bool]


def value_of(text: str) -> float:
    """Return the value of a number; NaN for what is none."""
    value = float(text) if len(text) <= LONGEST and NUMBER.fullmatch(text) else math.nan
    return value if math.isfinite(value) else math.nan


def between(low: float, high: float) -> Test:
    """Return the test of a number in an interval."""
    return lambda text: low <= value_of(text) <= high


def whole(low: int, high: int) -> Test:
    """Return the test of a whole number in an interval."""
    return lambda text: len(text) <= LONGEST and bool(WHOLE.fullmatch(text)) and low <= int(text) <= high


def length(text: str) -> bool:
    """Whether a text is a length."""
    return 0 < value_of(text) <= FARTHEST


def three(part: Test) -> Test:
    """Return the test of three parts with commas between them."""
    return lambda text: text.count(",") == 2 and all(map(part, text.split(",")))


ratio, byte, point, lengths = between(0, 1), whole(0, 255), three(between(-FARTHEST, FARTHEST)), three(length)
colour, component = three(byte), three(between(-1, 1))


def without_homogeneous_zero(text: str) -> str:
    """Return a direction without its fourth component, if that is 0."""
    head, _, last = text.rpartition(",")
    return head if text.count(",") == 3 and value_of(last) == 0 else text


def may_be_zero(text: str) -> bool:
    """Whether a text is the direction of a camera, which may be 0,0,0."""
    return component(without_homogeneous_zero(text))


def direction(text: str) -> bool:
    """Whether a text is a direction."""
    text = without_homogeneous_zero(text)
    return component(text) and any(map(value_of, text.split(",")))


def picture(text: str) -> bool:
    """Whether a text is the name of a picture."""
    return exists(text, ".png")


def mesh(text: str) -> bool:
    """Whether a text is the name of a mesh."""
    return exists(text, ".obj")


def paint(text: str) -> bool:
    """Whether a text is a colour or the name of a picture."""
    return colour(text) if "," in text else picture(text)


def parts(*tests: tuple[int, Test], least: int) -> Test:
    """Return the test of values with commas between them; each takes some parts, and the last ones may be left out."""

    def test(text: str) -> bool:
        words, count = text.split(","), 0
        for width, each in tests:
            if not words and count >= least:
                return True
            if len(words) < width or not each(",".join(words[:width])):
                return False
            words, count = words[width:], count + 1
        return not words

    return test
