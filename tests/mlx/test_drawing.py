"""Text, images and alpha blending without a window, against references: all values, and any sequence of calls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from PIL import Image as Pillow

from minirt.mlx import Mlx
from minirt.mlx.canvas import BLOCK, Canvas, blend, stretch
from minirt.mlx.memory import Memory
from minirt.mlx.text import draw_text, measure

if TYPE_CHECKING:
    from pathlib import Path

LEVELS = np.arange(256, dtype=np.uint32)


def test_blending_is_exact_for_all_values() -> None:
    """Every result is (source * alpha + below * (255 - alpha)) / 255, rounded to nearest."""
    source, below = np.meshgrid(LEVELS, LEVELS)
    for alpha in range(256):
        words = 0xFF000000 | below << 16 | (255 - below) << 8 | below
        blend(words, np.uint32(alpha << 24) | source << 16 | (255 - source) << 8 | source)
        exact = (2 * (source * alpha + below * (255 - alpha)) + 255) // 510
        # The sum for 255 - source and 255 - below is 255 * 255 less this one, and a half does not occur.
        assert np.array_equal(words, 0xFF000000 | exact << 16 | (255 - exact) << 8 | exact)


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


def test_stretch_takes_the_nearest_pixel() -> None:
    pixels = np.arange(6, dtype=np.uint8).repeat(4).reshape(2, 3, 4)
    assert stretch(pixels, 6, 4)[..., 0].tolist() == [[0, 0, 1, 1, 2, 2]] * 2 + [[3, 3, 4, 4, 5, 5]] * 2
    assert stretch(pixels, 1, 1)[..., 0].tolist() == [[4]]
    assert np.array_equal(stretch(pixels, 3, 2), pixels)


def test_text_stays_within_the_measured_size() -> None:
    pixels = np.zeros((120, 300, 4), np.uint8)
    text = "Sphere |gjQ|\nsecond line"
    assert draw_text(pixels, 20, 30, text, 0xFF8000, size=20) == measure(text, 20)
    width, height = measure(text, 20)
    drawn = pixels[..., :3].max(axis=2) > 0
    assert drawn[30 : 30 + height, 20 : 20 + width].sum() == drawn.sum() > 300
    assert height == 2 * measure("x", 20)[1]
    assert pixels.max(axis=(0, 1)).tolist() == [0, 0x80, 0xFF, 0xFF]  # blue, green, red


def test_text_has_the_pitch_of_the_wrapper() -> None:
    """Programs centre and align text with 10 pixels a character."""
    pixels = np.zeros((30, 300, 4), np.uint8)
    assert draw_text(pixels, 0, 5, "iWiMi i", 0xFFFFFF, pitch=10) == (70, measure("x")[1])
    drawn = pixels[..., :3].any(axis=(0, 2))
    cells = drawn[:70].reshape(7, 10)
    assert cells[[0, 2, 4, 6]].tolist() == [cells[0].tolist()] * 4, "each character has its cell"
    assert cells[0, 3:7].any()
    assert not cells[0, [0, 1, 8, 9]].any()
    assert cells[[1, 3]].sum() >= 16, "wide characters fill it"
    assert not cells[5].any()
    assert not drawn[70:].any()


def test_a_ligature_has_one_pitch() -> None:
    pixels = np.zeros((30, 100, 4), np.uint8)
    assert draw_text(pixels, 0, 5, "aœb", 0xFFFFFF, pitch=10)[0] == 30
    cells = pixels[..., :3].any(axis=(0, 2))[:50].reshape(5, 10)
    assert cells.any(axis=1).tolist() == [True] * 3 + [False] * 2


def test_text_is_blended_with_the_pixels_below() -> None:
    black = np.zeros((40, 100, 4), np.uint8)
    grey = np.full((40, 100, 4), 100, np.uint8)
    draw_text(black, 5, 5, "mix", 0xFFFFFF)
    draw_text(grey, 5, 5, "mix", 0xFFFFFF)
    ink = black[..., 0] / 255.0
    assert 0.0 < np.median(ink[ink > 0]) < 1.0
    np.testing.assert_allclose(grey[..., 0], 100 + 155 * ink, atol=0.51)


def test_background_is_blended_by_its_alpha() -> None:
    pixels = np.full((60, 100, 4), 200, np.uint8)
    width, height = draw_text(pixels, 10, 10, " ", 0xFFFFFF, background=0x80000064, padding=3)
    box = np.zeros((60, 100), bool)
    box[7 : 13 + height, 7 : 13 + width] = True
    assert np.unique(pixels[box], axis=0).tolist() == [[150, 100, 100, 255]]
    assert (pixels[~box] == 200).all()


@given(st.integers(-90, 110), st.integers(-50, 60))
def test_text_is_clipped(x: int, y: int) -> None:
    """Clipped text equals a part of a larger picture."""
    large = np.zeros((150, 300, 4), np.uint8)
    small = np.zeros((50, 100, 4), np.uint8)
    for pixels, left, top in ((large, 100, 50), (small, 0, 0)):
        draw_text(pixels, x + left, y + top, "clipped", 0xFFFFFF, background=0x40FFFFFF, padding=2)
    assert np.array_equal(small, large[50:100, 100:200])


def test_empty_text_draws_nothing() -> None:
    pixels = np.zeros((20, 20, 4), np.uint8)
    assert draw_text(pixels, 0, 0, "", 0xFFFFFF)[0] == 0
    assert not pixels.any()


def test_data_addr_is_the_memory_of_the_image() -> None:
    m = Mlx(Memory())
    image = m.mlx_new_image(m.mlx_init(), 6, 4)
    data, bits, line, kind = m.mlx_get_data_addr(image)
    assert (len(data), bits, line, kind) == (96, 32, 24, 0)
    data[2 * line + 5 * 4 : 2 * line + 6 * 4] = bytes((1, 2, 3, 4))
    assert image.pixels[2, 5].tolist() == [1, 2, 3, 4]
    assert (image.width, image.height) == (6, 4)


def test_files_become_images(tmp_path: Path) -> None:
    m = Mlx(Memory())
    mlx = m.mlx_init()
    Pillow.fromarray(np.array([[[1, 2, 3], [4, 5, 6]]], np.uint8)).save(tmp_path / "a.png")
    xpm = '/* XPM */\nstatic char *a[] = {\n"2 1 2 1",\n"a c #010203",\n"b c #040506",\n"ab"\n};\n'
    (tmp_path / "a.xpm").write_text(xpm)
    for load, name in ((m.mlx_png_file_to_image, "a.png"), (m.mlx_xpm_file_to_image, "a.xpm")):
        image, width, height = load(mlx, tmp_path / name)
        assert (width, height) == (2, 1)
        assert image.pixels.tolist() == [[[3, 2, 1, 255], [6, 5, 4, 255]]]


def test_accents_are_strokes_above_small_letters_and_left_out_on_capitals() -> None:
    def drawn(text: str) -> np.ndarray:
        pixels = np.zeros((24, 60, 4), np.uint8)
        draw_text(pixels, 0, 0, text, 0xFFFFFF)
        return pixels[..., 0]

    for accented, plain in ("éa", "ea"), ("èa", "ea"), ("êa", "ea"), ("aï", "ai"), ("ça", "ca"), ("ôx", "ox"):
        assert measure(accented) == measure(plain)
        changed = (drawn(accented) != drawn(plain)).nonzero()[0]
        below = accented.startswith("ç")
        assert changed.size
        assert (changed.min() > 10) if below else (changed.max() < 10)
    assert (drawn("Éa") == drawn("Ea")).all()
    assert measure("œuf")[0] == measure("oeuf")[0]
