"""Pictures are written from the memory of their frame buffer, with the bytes that a copy gives."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

from minirt.formats import in_frame
from minirt.formats.table import FORMATS, is_installed
from minirt.image import Image

STILL = [name for name, each in FORMATS.items() if each.is_still and 8 in each.bits and name != "PNG"]


def frame(height: int, width: int) -> np.ndarray:
    """Return a frame buffer of random colours, above rows of a single one."""
    pixels = np.random.default_rng(height).integers(256, size=(height, width, 4), dtype=np.uint8)
    pixels[height // 2 :] = 7, 8, 9, 10
    return pixels


def encoded(image: Image, name: str, in_place: bool) -> bytes:
    """Return the file of a picture."""
    buffer = io.BytesIO()
    image.write(buffer, name, None, None, {}, in_place)
    return buffer.getvalue()


@pytest.mark.parametrize("name", STILL)
@pytest.mark.parametrize("size", [(1, 1), (33, 47)], ids=["pixel", "odd"])
def test_the_file_is_that_of_a_copy(name: str, size: tuple[int, int]) -> None:
    if not is_installed(name):
        pytest.skip("this Pillow was built without it")
    pixels = frame(*size)
    copied = Image.from_bgra(pixels)
    image = Image.from_bgra(pixels, in_place=True)
    assert encoded(image, name, in_place=True) == encoded(copied, name, in_place=False)


@pytest.mark.parametrize("block", [1, 2, 5, 6, 100])
def test_pixels_move_apart_in_their_own_memory(monkeypatch: pytest.MonkeyPatch, block: int) -> None:
    monkeypatch.setattr(in_frame, "BLOCK", block)
    pixels = frame(5, 7)
    expected = [[(red, green, blue) for blue, green, red, _ in row] for row in pixels.tolist()]
    picture = in_frame.in_frame(Image.from_bgra(pixels, in_place=True).array)
    assert picture is not None
    assert picture.mode == "RGB"
    assert [[picture.getpixel((x, y)) for x in range(7)] for y in range(5)] == expected
    assert [[tuple(each) for each in row] for row in pixels[..., :3].tolist()] == expected
    assert (pixels[..., 3] == 255).all()
    pixels[4, 6, :3] = 1, 2, 3
    assert picture.getpixel((6, 4)) == (1, 2, 3)  # the same memory


def test_the_image_keeps_its_memory() -> None:
    array = in_frame.levels_in_frame(300, 400)
    array[...] = 77
    picture = in_frame.in_frame(array)
    del array
    assert picture is not None
    assert np.array_equal(np.asarray(picture), np.full((300, 400, 3), 77))


def read_only() -> np.ndarray:
    """Return a picture that begins a frame buffer which cannot be written."""
    pixels = np.zeros((4, 5, 4), np.uint8)
    array = pixels.reshape(-1)[:60].reshape(4, 5, 3)
    pixels.flags.writeable = False
    return array


PLAIN = {
    "own memory": np.zeros((4, 5, 3), np.uint8),
    "end of memory": np.zeros((4, 5, 4), np.uint8).reshape(-1)[20:].reshape(4, 5, 3),
    "little memory": np.zeros(79, np.uint8)[:60].reshape(4, 5, 3),
    "channels of a frame": np.zeros((4, 5, 4), np.uint8)[..., :3],
    "bytes": np.frombuffer(bytes(80), np.uint8)[:60].reshape(4, 5, 3),
    "read only": read_only(),
    "no pixels": np.zeros((0, 5, 4), np.uint8).reshape(-1)[:0].reshape(0, 5, 3),
}


@pytest.mark.parametrize("array", PLAIN.values(), ids=PLAIN)
def test_a_picture_outside_a_frame_buffer_is_copied(array: np.ndarray) -> None:
    assert in_frame.frame_of(array) is None
    assert in_frame.in_frame(array) is None


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif"])
def test_a_picture_is_not_overwritten_unless_that_is_asked_for(suffix: str, tmp_path: Path) -> None:
    image = Image.from_bgra(frame(33, 47), in_place=True)
    before = image.array.copy()
    image.save(tmp_path / f"a{suffix}")
    assert np.array_equal(image.array, before)
    image.save(tmp_path / f"b{suffix}", in_place=True)
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
    assert np.array_equal(image.array, before) == (suffix == ".png")
