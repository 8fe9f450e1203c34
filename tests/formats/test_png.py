"""PNG files are read back by Pillow bit by bit, whatever filters their rows have."""

from __future__ import annotations

import io
from collections.abc import Iterator

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.formats import png

Array = np.ndarray
RANDOM = np.random.default_rng(7)


def read(data: bytes) -> Array:
    """The pixels of a PNG file, read by Pillow."""
    with pillow.open(io.BytesIO(data)) as image:
        assert (image.format, image.mode) == ("PNG", "RGB")
        image.load()
        return np.asarray(image)


def pictures() -> Iterator[Array]:
    """Pictures of all sorts: noise, slopes, stripes and flat colours, of one block of rows and of several."""
    for height, width in ((1, 1), (1, 7), (7, 1), (5, 6), (png.ROWS, 3), (2 * png.ROWS + 1, 4)):
        y, x, channel = np.mgrid[:height, :width, :3]
        yield RANDOM.integers(0, 256, (height, width, 3)).astype(np.uint8)
        yield (7 * x + channel).astype(np.uint8)
        yield (5 * y - channel).astype(np.uint8)
        yield (128 * (x % 2) + channel).astype(np.uint8)
        yield np.full((height, width, 3), 128, np.uint8)


def check() -> None:
    """Every picture is read back as it was."""
    for picture in pictures():
        assert np.array_equal(read(png.encode(picture)), picture)


def filters(picture: Array) -> list[int]:
    """The filters that the rows of a picture get."""
    return [rows[at] for rows in png.filtered(picture.reshape(len(picture), -1)) for at in starts(rows, picture)]


def starts(rows: bytes, picture: Array) -> range:
    return range(0, len(rows), 1 + picture[0].size)


def test_every_picture_is_read_back() -> None:
    check()


def test_each_filter_is_used_where_it_helps() -> None:
    y, x, _ = np.mgrid[:4, :50, :3]
    assert filters((x * 2).astype(np.uint8))[0] == png.SUB
    assert filters((x * 31 % 251).astype(np.uint8))[1:] == [png.UP] * 3
    assert filters(((x + y) % 2).astype(np.uint8)) == [png.NONE] * 4


def test_a_view_of_a_larger_picture_is_encoded() -> None:
    large = RANDOM.integers(0, 256, (9, 9, 4)).astype(np.uint8)
    assert np.array_equal(read(png.encode(large[1::2, ::-1, 2::-1])), large[1::2, ::-1, 2::-1])


def test_a_rendered_picture_is_not_much_larger_than_that_of_pillow() -> None:
    y, x = np.mgrid[-1:1:300j, -1:1:400j]
    light = np.sqrt(np.maximum(0, 0.5 - x * x - y * y))[..., None] * [300, 200, 100]
    picture = light.clip(0, 255).astype(np.uint8)
    buffer = io.BytesIO()
    pillow.fromarray(picture).save(buffer, "PNG")
    assert len(png.encode(picture)) < 1.1 * len(buffer.getvalue())


@pytest.mark.parametrize("shape", [(0, 4, 3), (4, 0, 3)])
def test_a_picture_without_pixels_is_an_error(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="pixels"):
        png.encode(np.zeros(shape, np.uint8))
