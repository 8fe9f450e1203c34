"""Place labels beside the points that they name, where they cover nothing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from math import cos, hypot, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.report.output.svg import Point

WIDTH, HEIGHT = 0.62, 1.15  # of a letter and of a line, in units of the font's size; most letters are narrower
DIRECTIONS = [pi / 4 * step for step in (7, 1, 3, 5, 0, 4, 6, 2)]  # right above first; clockwise from the right
STEP = 5.0  # pixels between two boxes that stand for a line


class Box(NamedTuple):
    """A rectangle along the axes."""

    left: float
    top: float
    right: float
    bottom: float


class Placed(NamedTuple):
    """A label's box, the point that it names, and whether it is so far away that a line should join them."""

    box: Box
    anchor: Point
    is_far: bool


class Placer:
    """Keeps the boxes that are taken, and finds free ones inside of a frame."""

    def __init__(self, frame: Box) -> None:
        self.frame = frame
        self.taken: list[Box] = []  # by labels and marks: never covered
        self.crossed: list[Box] = []  # by lines: covered if nothing else is free

    def take(self, at: Point, radius: float) -> None:
        """Keep the square around a mark free."""
        self.taken.append(Box(at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius))

    def cross(self, points: Sequence[Point]) -> None:
        """Note a line through some points, which labels cover only unwillingly."""
        for (x, y), (to_x, to_y) in pairwise(points):
            count = int(hypot(to_x - x, to_y - y) / STEP) + 1
            for share in np.linspace(0, 1, count + 1).tolist():
                at = x + share * (to_x - x), y + share * (to_y - y)
                self.crossed.append(Box(at[0] - 1, at[1] - 1, at[0] + 1, at[1] + 1))

    def place(self, words: str, size: float, anchors: Iterable[Point], distances: Iterable[float]) -> Placed | None:
        """Take the best free box at one of the anchors, near ones first; None if all are taken."""
        width, height = WIDTH * size * len(words), HEIGHT * size
        choices = list(beside(width, height, anchors, distances))
        best = self.best([placed.box for placed, _ in choices], [cost for _, cost in choices])
        if best is None:
            return None
        self.taken.append(choices[best][0].box)
        return choices[best][0]

    def place_upright(self, words: str, size: float, x: float) -> Placed | None:
        """Take the best free box for words that run upwards beside a vertical line at x; None if all are taken."""
        width, height = HEIGHT * size, WIDTH * size * len(words)
        tops = np.arange(self.frame.top, self.frame.bottom - height, 4.0).tolist()
        boxes = [Box(left, top, left + width, top + height) for top in tops for left in (x + 2, x - width - 2)]
        best = self.best(boxes, [0.0] * len(boxes))
        if best is None:
            return None
        self.taken.append(boxes[best])
        return Placed(boxes[best], (x, boxes[best].bottom), is_far=False)

    def best(self, boxes: list[Box], costs: list[float]) -> int | None:
        """Return the index of the cheapest free box, or None; each piece of a line that it covers costs 6 pixels."""
        tried, frame = np.array(boxes).reshape(-1, 4), self.frame
        inside = (tried[:, :2] >= frame[:2]).all(axis=1) & (tried[:, 2:] <= frame[2:]).all(axis=1)
        free = inside & (overlaps(tried, self.taken) == 0)
        if not free.any():
            return None
        return int(np.where(free, np.array(costs) + 6 * overlaps(tried, self.crossed), np.inf).argmin())


def beside(
    width: float, height: float, anchors: Iterable[Point], distances: Iterable[float]
) -> Iterator[tuple[Placed, float]]:
    """Yield boxes around each anchor, and how unwelcome each is, in pixels."""
    distances = list(distances)
    for rank, (x, y) in enumerate(anchors):
        for distance in distances:
            for place, angle in enumerate(DIRECTIONS):
                middle_x = x + (distance + width / 2) * cos(angle) / max(abs(cos(angle)), abs(sin(angle)))
                middle_y = y + (distance + height / 2) * sin(angle) / max(abs(cos(angle)), abs(sin(angle)))
                box = Box(middle_x - width / 2, middle_y - height / 2, middle_x + width / 2, middle_y + height / 2)
                yield Placed(box, (x, y), distance > 12), distance + place + 2 * rank


def overlaps(boxes: NDArray[np.float64], others: list[Box]) -> NDArray[np.intp]:
    """Count for each box the others that it overlaps."""
    other = np.array(others).reshape(-1, 4)
    one = boxes[:, None]
    apart = (one[..., 2:] <= other[:, :2]).any(axis=-1) | (other[:, 2:] <= one[..., :2]).any(axis=-1)
    found: NDArray[np.intp] = np.count_nonzero(~apart, axis=1)
    return found
