"""Text and images without a window."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image as Pillow

from minirt.mlx import Mlx
from minirt.mlx.canvas import stretch
from minirt.mlx.memory import Memory
from minirt.mlx.text import draw_text, measure

if TYPE_CHECKING:
    from pathlib import Path


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
