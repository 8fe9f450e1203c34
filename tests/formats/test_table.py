"""Every format of the table holds a picture in its colours and size, PNG with any filter; others are refused."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.errors import RenderError
from minirt.formats import png, table
from minirt.formats.table import BY_SUFFIX, FILMS_BY_PYAV, FORMATS, check_size, format_of, is_installed
from minirt.rendering.image import Image

ARRAY = np.moveaxis(np.indices((200, 300)).repeat(2, axis=0)[:3], 0, -1).astype(np.uint8)
FLOATS = {"EXR", "HDR", "PFM"}  # see `test_floats.py`
STILL = [s for s, name in BY_SUFFIX.items() if FORMATS[name].is_still and name not in FLOATS and is_installed(name)]


@pytest.mark.parametrize("suffix", STILL)
def test_pillow_reads_back_what_is_written(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix.upper()}"
    Image(ARRAY).save(str(path))
    with pillow.open(path) as image:
        found = np.asarray(image.convert("RGB")).astype(int)
    assert found.shape == ARRAY.shape
    error = np.abs(found - ARRAY).mean()
    name = format_of(path)
    assert error <= (8 if FORMATS[name].is_lossy or name == "GIF" else 0)


@pytest.mark.parametrize(
    "suffix", [".pgm", ".pbm", ".ico", ".icns", ".xbm", ".eps", ".spider", ".txt", ".rt", "", ".", "/.png", ".png/b"]
)
def test_other_extensions_are_refused(suffix: str) -> None:
    with pytest.raises(RenderError, match=r"cannot write pictures with the extension|the name of a picture ends in "):
        format_of(f"a{suffix}")


@pytest.mark.parametrize(
    ("name", "advice"),
    [
        ("a.pgm", "it cannot hold colours, try .png"),
        ("a.jpgg", "try .jpg"),
        ("a.xyzzy", "try .png"),
        ("a", "ends in its format, such as .png"),
    ],
)
def test_a_refusal_says_what_to_do(name: str, advice: str) -> None:
    with pytest.raises(RenderError, match=advice):
        format_of(name)


@pytest.mark.parametrize(
    ("has_pyav", "advice"), [(True, ", try .mp4, .webm or .gif"), (False, "or try .gif, .webp or")]
)
@pytest.mark.parametrize("name", ["a.avi", "a.MOV", "a.mkv", "a.mpg"])
def test_a_film_is_suggested_for_a_film(
    monkeypatch: pytest.MonkeyPatch, name: str, has_pyav: bool, advice: str
) -> None:
    monkeypatch.setattr(table, "is_installed", lambda name: has_pyav or name not in FILMS_BY_PYAV)
    with pytest.raises(RenderError, match=f"cannot write films with the extension .*{advice}"):
        format_of(name)


def test_a_library_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table, "is_installed", lambda name: name not in FILMS_BY_PYAV | {"AVIF"})
    with pytest.raises(
        RenderError, match=r"install PyAV \(pip install 'minirt\[video\]'\) for .mp4 and .webm, or try .gif"
    ):
        format_of("a.mp4")
    with pytest.raises(RenderError, match="this Pillow was built without it"):
        format_of("a.avif")


@pytest.mark.parametrize("name", ["WEBP", "GIF", "JPEG"])
def test_the_largest_side_is_the_formats_own(name: str) -> None:
    largest = FORMATS[name].largest
    check_size("a", name, largest, 1)
    with pytest.raises(RenderError, match=f"a: {name} holds at most {largest:,} pixels a side, got 1x{largest + 1}"):
        check_size("a", name, 1, largest + 1)
    assert Image(np.zeros((1, largest, 3), np.uint8)).encode(name)
    if name != "JPEG":  # whose library allows a few pixels more in some versions
        with pytest.raises(RenderError, match=f"cannot write this picture as {name}"):
            Image(np.zeros((1, largest + 1, 3), np.uint8)).encode(name)


def test_quality_is_for_lossy_formats() -> None:
    rough, fine = (len(Image(ARRAY).encode("JPEG", quality=quality)) for quality in (5, 95))
    assert rough < fine
    with pytest.raises(RenderError, match="PNG has no quality"):
        Image(ARRAY).encode("PNG", quality=5)
    for wrong in (0, 101):
        with pytest.raises(RenderError, match="from 1 to 100"):
            Image(ARRAY).encode("JPEG", quality=wrong)


def test_a_frame_buffer_is_copied_to_rgb() -> None:
    pixels = np.array([[[3, 2, 1, 255], [30, 20, 10, 0]]], np.uint8)
    image = Image.from_bgra(pixels)
    assert image.array.tolist() == [[[1, 2, 3], [10, 20, 30]]]
    pixels[:] = 0
    assert image.array[0, 0].tolist() == [1, 2, 3]  # a copy
    assert image.linear is None


# PNG files are read back by Pillow bit by bit, whatever filters their rows have.


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


def filters(picture: Array) -> list[int]:
    """The filters that the rows of a picture get."""
    return [rows[at] for rows in png.filtered(picture.reshape(len(picture), -1)) for at in starts(rows, picture)]


def starts(rows: bytes, picture: Array) -> range:
    return range(0, len(rows), 1 + picture[0].size)


@pytest.mark.parametrize("encode", [Image.encode, Image._repr_png_])
def test_a_picture_is_encoded_as_png(encode: Callable[[Image], bytes]) -> None:
    assert np.array_equal(read(encode(Image(ARRAY))), ARRAY)


def test_every_picture_is_read_back() -> None:
    for picture in pictures():
        assert np.array_equal(read(png.encode(picture)), picture)


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
