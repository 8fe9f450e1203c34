"""Pictures are converted, encoded and saved without a change of their pixels."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.errors import RenderError
from minirt.rendering.image import Image, format_of

ARRAY = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3) * 3


def test_a_frame_buffer_is_copied_to_rgb() -> None:
    pixels = np.array([[[3, 2, 1, 255], [30, 20, 10, 0]]], np.uint8)
    image = Image.from_bgra(pixels)
    assert image.array.tolist() == [[[1, 2, 3], [10, 20, 30]]]
    pixels[:] = 0
    assert image.array[0, 0].tolist() == [1, 2, 3]  # a copy
    assert image.linear is None


def test_the_pillow_image_has_the_same_pixels() -> None:
    image = Image(ARRAY)
    assert image.pil.size == (6, 4)
    assert image.pil.mode == "RGB"
    assert np.array_equal(np.asarray(image.pil), ARRAY)


@pytest.mark.parametrize("encode", [Image.encode, Image._repr_png_])
def test_a_picture_is_encoded_as_png(encode: object) -> None:
    with pillow.open(io.BytesIO(encode(Image(ARRAY)))) as image:  # type: ignore[operator]
        assert image.format == "PNG"
        assert np.array_equal(np.asarray(image), ARRAY)


@pytest.mark.parametrize("suffix", [".png", ".bmp", ".ppm", ".tiff"])
def test_a_saved_picture_reads_back(tmp_path: Path, suffix: str) -> None:
    for path in (tmp_path / f"a{suffix}", str(tmp_path / f"b{suffix.upper()}")):
        Image(ARRAY).save(path)
        with pillow.open(path) as image:
            assert np.array_equal(np.asarray(image), ARRAY)


@pytest.mark.parametrize(
    ("name", "format"),
    [("a.png", "PNG"), ("a.JPG", "JPEG"), ("a.jpeg", "JPEG"), ("b/c.webp", "WEBP"), ("a.b.ppm", "PPM")],
)
def test_the_extension_selects_the_format(name: str, format: str) -> None:
    assert format_of(name) == format
    assert format_of(Path(name)) == format


@pytest.mark.parametrize("name", ["a", "a.", "a.xyz", "png", ".png", "a.png/b"])
def test_an_unknown_extension_is_an_error(name: str) -> None:
    with pytest.raises(RenderError, match="cannot write pictures with the extension"):
        format_of(name)


def test_a_picture_too_large_for_its_format_is_an_error() -> None:
    with pytest.raises(RenderError, match="cannot write this picture as JPEG"):
        Image(np.zeros((1, 70_000, 3), np.uint8)).encode("JPEG")


def test_a_path_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match="No such file or directory"):
        Image(ARRAY).save(tmp_path / "nowhere" / "a.png")
    (tmp_path / "a.png").mkdir()
    with pytest.raises(RenderError, match="not a regular file"):
        Image(ARRAY).save(tmp_path / "a.png")
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]
