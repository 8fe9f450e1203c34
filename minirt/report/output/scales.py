"""Logarithmic scales, and the axes that show them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil, floor, isfinite, log10
from typing import NamedTuple

from minirt.report.output.svg import Point, group, path, text

LABEL_WIDTH, LABEL_HEIGHT = 40.0, 18.0  # pixels that a label of an axis takes
LEAST_RANGE = 6.0  # ratio of the ends of a scale, which then has two of 1, 2, 5, 10 between them


class Scale(NamedTuple):
    """Logarithmic map from values between `low` and `high` to pixels between `start` and `end`."""

    low: float
    high: float
    start: float
    end: float

    def __call__(self, value: float) -> float:
        """Return the pixel of a value; values beyond the ends lie at the ends."""
        share = log10(min(max(value, self.low), self.high) / self.low) / self.decades
        return self.start + share * (self.end - self.start)

    @property
    def decades(self) -> float:
        """Number of powers of ten from end to end."""
        return log10(self.high / self.low)

    def holds(self, value: float) -> bool:
        """Whether a value lies on the scale."""
        return self.low <= value <= self.high

    def ticks(self) -> Iterator[tuple[int, float]]:
        """Yield 1 to 9 times each power of ten: the factor and the value."""
        for power in range(floor(log10(self.low)), ceil(log10(self.high)) + 1):
            yield from ((digit, tick) for digit in range(1, 10) if self.holds(tick := float(f"{digit}e{power}")))

    def labelled(self, room: float) -> list[float]:
        """Return the ticks with a label: decades, and 2 and 5 times each where labels `room` pixels wide fit."""
        has_room = log10(2) * abs(self.end - self.start) / self.decades >= room
        decades = [tick for digit, tick in self.ticks() if digit == 1]
        return [tick for digit, tick in self.ticks() if digit in (1, 2, 5)] if has_room or len(decades) < 2 else decades


def scale_around(values: Iterable[float], start: float, end: float, margin: float = 1.4) -> Scale:
    """Return a scale that holds all positive values, with a margin on both sides."""
    found = [value for value in values if isfinite(value) and value > 0] or [1.0]
    low, high = min(found) / margin, max(found) * margin
    widening = max(1.0, LEAST_RANGE * low / high) ** 0.5
    return Scale(low / widening, high * widening, start, end)


def horizontal_axis(scale: Scale, top: float, bottom: float, title: str) -> str:
    """Draw vertical grid lines, and their labels and the title of the axis below them."""
    lines = (grid_line(digit, (scale(tick), top), (scale(tick), bottom)) for digit, tick in scale.ticks())
    labels = (
        text(f"{tick:g}", (scale(tick), bottom + 17), text_anchor="middle") for tick in scale.labelled(LABEL_WIDTH)
    )
    middle = (scale.start + scale.end) / 2
    return group([*lines, *labels, text(title, (middle, bottom + 38), text_anchor="middle")], class_="axis")


def vertical_axis(scale: Scale, left: float, right: float, title: str) -> str:
    """Draw horizontal grid lines, their labels left of them, and the title of the axis above."""
    lines = (grid_line(digit, (left, scale(tick)), (right, scale(tick))) for digit, tick in scale.ticks())
    labels = (
        text(f"{tick:g}", (left - 6, scale(tick) + 4), text_anchor="end") for tick in scale.labelled(LABEL_HEIGHT)
    )
    top = min(scale.start, scale.end)
    return group([*lines, *labels, text(title, (8.0, top - 12))], class_="axis")


def grid_line(digit: int, start: Point, end: Point) -> str:
    """Draw a line of the grid, stronger for a power of ten."""
    return path([start, end], class_="decade" if digit == 1 else "grid")
