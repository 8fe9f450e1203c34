"""Alpha blending against references: every combination of values, and any sequence of drawing calls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from minirt.mlx.canvas import BLOCK, Canvas, blend

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Words = NDArray[np.uint32]
    Blend = Callable[[Words, Words], None]

LEVELS = np.arange(256, dtype=np.uint32)


def is_exact(blended: Blend) -> bool:
    """Whether every result is (source * alpha + below * (255 - alpha)) / 255, rounded to nearest."""
    source, below = np.meshgrid(LEVELS, LEVELS)
    for alpha in range(256):
        words = 0xFF000000 | below << 16 | (255 - below) << 8 | below
        blended(words, np.uint32(alpha << 24) | source << 16 | (255 - source) << 8 | source)
        exact = (2 * (source * alpha + below * (255 - alpha)) + 255) // 510
        # The sum for 255 - source and 255 - below is 255 * 255 less this one, and a half does not occur.
        if not np.array_equal(words, 0xFF000000 | exact << 16 | (255 - exact) << 8 | exact):
            return False
    return True


def test_blending_is_exact_for_all_values() -> None:
    assert is_exact(blend)


@pytest.mark.parametrize("shape", [(1, 1), (3, 7), (5, BLOCK // 2), (2, BLOCK + 1)])
def test_blocks_cover_the_picture(shape: tuple[int, int]) -> None:
    """Opaque, transparent and mixed rows give what each pixel alone gives."""
    random = np.random.default_rng(3)
    source = random.integers(0, 2**32, shape, np.uint32)
    source[0::3] |= 0xFF000000
    source[1::3] &= 0x00FFFFFF
    below = 0xFF000000 | random.integers(0, 2**24, shape, np.uint32)
    expected = below.copy()
    cut_to_nearest = (source >> 24, 255 - (source >> 24))
    for shift in (0, 8, 16):
        total = (source >> shift & 255) * cut_to_nearest[0] + (below >> shift & 255) * cut_to_nearest[1]
        expected = expected & ~np.uint32(255 << shift) | (2 * total + 255) // 510 << shift
    wide = np.zeros((shape[0], shape[1] + 3), np.uint32)
    wide[:, 1:-2] = below
    blend(wide[:, 1:-2], source)
    assert np.array_equal(wide[:, 1:-2], expected)
    assert not wide[:, [0, -2, -1]].any()


WIDTH, HEIGHT = 5, 4
places = st.integers(-3, 6)
colours = st.sampled_from((0, 0x00FFFFFF, 0x01808080, 0x7F10F0A0, 0x80FF00FF, 0xFE123456, 0xFF0000FF, 0xFFFFFFFF))
calls = st.one_of(
    st.tuples(st.just("point"), places, places, colours),
    st.tuples(st.just("put"), places, places, colours),
    st.tuples(st.just("clear"), places, places, colours),
    st.tuples(st.just("look"), places, places, colours),
)


class Reference:
    """A canvas pixel by pixel: single pixels wait in a layer, where the last one of each place counts.

    touched: the pixels that were drawn on since the last look, whatever their colours.
    """

    def __init__(self) -> None:
        self.pixels = {(x, y): (0, 0, 0) for x in range(WIDTH) for y in range(HEIGHT)}
        self.layer: dict[tuple[int, int], int] = {}
        self.touched = set(self.pixels)

    def look(self) -> tuple[int, int, int, int] | None:
        """Return the bounding box of what was touched, or None, and forget it."""
        touched, self.touched = self.touched & self.pixels.keys(), set()
        if not touched:
            return None
        columns, rows = zip(*touched, strict=True)
        return min(columns), min(rows), max(columns) + 1, max(rows) + 1

    def draw(self, kind: str, x: int, y: int, colour: int) -> None:
        if kind == "point":
            self.layer[x, y] = colour
            self.touched.add((x, y))
            return
        self.merge()
        if kind == "clear":
            self.pixels = dict.fromkeys(self.pixels, (0, 0, 0))
            self.touched.update(self.pixels)
        elif kind == "put":
            for place in ((x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)):
                self.blend(place, colour)
                self.touched.add(place)

    def merge(self) -> None:
        for place, colour in self.layer.items():
            self.blend(place, colour)
        self.layer = {}

    def blend(self, place: tuple[int, int], colour: int) -> None:
        if place in self.pixels:
            alpha, *levels = colour.to_bytes(4, "big")
            old = self.pixels[place]
            mixed = [
                (2 * (new * alpha + level * (255 - alpha)) + 255) // 510 for new, level in zip(levels, old, strict=True)
            ]
            self.pixels[place] = mixed[0], mixed[1], mixed[2]


@example([("point", 2, 1, 0x01808080), ("put", 0, -2, 0), ("point", 2, 1, 0)])  # a picture outside of the canvas
@given(st.lists(calls, max_size=12))
def test_any_sequence_of_calls_gives_the_picture_of_the_reference(steps: list[tuple[str, int, int, int]]) -> None:
    canvas, reference = Canvas(WIDTH, HEIGHT, alpha=True), Reference()
    for kind, x, y, colour in steps:
        reference.draw(kind, x, y, colour)
        if kind == "point":
            canvas.point(x, y, colour)
        elif kind == "put":
            canvas.put(np.full((2, 2), colour, "<u4").view(np.uint8).reshape(2, 2, 4), x, y)
        elif kind == "clear":
            canvas.clear()
        else:
            assert canvas.take_changes() == reference.look()
    assert canvas.changes == reference.look()
    reference.merge()
    expected = [[list(reference.pixels[x, y]) for x in range(WIDTH)] for y in range(HEIGHT)]
    assert canvas.pixels[..., 2::-1].tolist() == expected


def test_without_alpha_everything_is_copied() -> None:
    canvas = Canvas(3, 1)
    canvas.put(np.full((1, 1, 4), 7, np.uint8), 0, 0)
    canvas.point(2, 0, 0x00010203)
    assert canvas.pixels.tolist() == [[[7, 7, 7, 7], [0, 0, 0, 255], [3, 2, 1, 0]]]
