"""OpenEXR's own library, OpenCV and tifffile read back light from files of numbers, levels of 16 bits and BigTIFF."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.errors import RenderError
from minirt.formats import floats, tiff
from minirt.materials.radiance import read_header, read_pixels
from minirt.rendering.image import Image
from minirt.rendering.tone_mapping import light_of
from tests.formats.pictures import SIZES, light, picture

exr = pytest.importorskip("OpenEXR")
cv2 = pytest.importorskip("cv2")  # `make lowest` is without these
tifffile = pytest.importorskip("tifffile")


def read_exr(path: Path) -> np.ndarray:
    """The pixels of an EXR file, by OpenEXR."""
    with exr.File(str(path)) as file:
        pixels: np.ndarray = file.channels()["RGB"].pixels
        return pixels.copy()


def read_opencv(path: Path) -> np.ndarray:
    """The pixels of a file, by OpenCV, whose order is blue, green, red."""
    pixels: np.ndarray = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., ::-1]
    return pixels


def read_tiff(path: Path) -> np.ndarray:
    """The pixels of a TIFF file, by tifffile."""
    pixels: np.ndarray = tifffile.imread(path)
    return pixels


@pytest.mark.parametrize(("name", "read"), [("a.exr", read_exr), ("a.pfm", read_opencv), ("a.tif", read_tiff)])
@pytest.mark.parametrize("size", SIZES)
def test_float32_is_read_back_to_the_bit(
    tmp_path: Path, name: str, read: Callable[[Path], np.ndarray], size: tuple[int, int]
) -> None:
    picture(*size).save(tmp_path / name, bits=32)
    found = read(tmp_path / name)
    assert found.dtype == np.float32
    assert np.array_equal(found, light(*size).astype(np.float32))


def read_own(path: Path) -> np.ndarray:
    """The pixels of a Radiance file, by the reader of skies."""
    data = path.read_bytes()
    return read_pixels(data, read_header(data))


@pytest.mark.parametrize("read", [read_opencv, read_own])
@pytest.mark.parametrize("size", [*SIZES, (2, 40_000)])
def test_radiance_keeps_a_256th_of_the_largest_channel(
    tmp_path: Path, read: Callable[[Path], np.ndarray], size: tuple[int, int]
) -> None:
    made = light(*size)
    (tmp_path / "a.hdr").write_bytes(floats.encode_hdr(made))
    error = np.abs(read(tmp_path / "a.hdr") - made)
    assert (error <= made.max(axis=-1, keepdims=True) / 256).all()
    assert not error[-1, 0].any()  # black


def test_radiance_holds_what_its_exponent_can() -> None:
    made = np.array([[[1e-45, 0, 0], [2.0**-126, 0, 0], [1e39, 1, 1], [np.inf, 0, 0]]])
    data = floats.encode_hdr(made)
    found = read_pixels(data, read_header(data))[0, :, 0]
    assert found[0] == 0
    assert found[1:] == pytest.approx([2.0**-126, 255 * 2.0**119, 255 * 2.0**119], rel=1 / 256)


def test_runs_make_even_areas_small() -> None:
    assert len(floats.encode_hdr(np.full((100, 1000, 3), 0.3))) < 100 * 100


def test_noise_that_zip_cannot_compress_is_stored(tmp_path: Path) -> None:
    bits = np.random.default_rng(3).integers(0, 2**30, (20, 50, 3), np.uint32)
    made = bits.view(np.float32).astype(float)
    Image(np.zeros((20, 50, 3), np.uint8), made).save(tmp_path / "a.exr")
    assert np.array_equal(read_exr(tmp_path / "a.exr"), made.astype(np.float32))


@pytest.mark.parametrize(
    ("name", "bits", "message"),
    [
        *(
            (name, None, "32 bits need linear light, and this picture has levels of 8")
            for name in ("EXR", "HDR", "PFM")
        ),
        ("PNG", 16, "16 bits need linear light"),
        ("EXR", 16, "EXR has 32 bits a channel, got 16"),
    ],
)
def test_a_picture_without_light_is_refused(name: str, bits: int | None, message: str) -> None:
    with pytest.raises(RenderError, match=message):
        Image(np.zeros((2, 2, 3), np.uint8)).encode(name, bits=bits)


def curve(made: np.ndarray, tone: str) -> np.ndarray:
    """Levels in [0, 1] of light, by the formulas of IEC 61966-2-1 and of Narkowicz, in long doubles."""
    x = made.astype(np.longdouble)
    if tone == "filmic":
        x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)
    x = np.clip(x, 0, 1)
    return x if tone == "plain" else np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / np.longdouble(2.4)) - 0.055)


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.TIFF"])
@pytest.mark.parametrize("tone", ["plain", "srgb", "filmic"])
@pytest.mark.parametrize("size", SIZES)
def test_levels_are_the_nearest_to_the_light_on_the_curve(
    tmp_path: Path, name: str, tone: str, size: tuple[int, int]
) -> None:
    picture(*size, tone).save(tmp_path / name, bits=16)
    found = cv2.imread(str(tmp_path / name), cv2.IMREAD_UNCHANGED)[..., ::-1]
    assert found.dtype == np.uint16
    assert np.abs(found - 65535 * curve(light(*size), tone)).max() < 0.501


@pytest.mark.parametrize("tone", ["plain", "srgb", "filmic"])
def test_both_depths_agree_and_levels_stand_for_their_light(tone: str) -> None:
    levels = np.arange(256, dtype=np.uint8)
    made = light_of(levels / 255, tone)
    image = Image(np.zeros((1, 256, 3), np.uint8), np.repeat(made[None, :, None], 3, axis=2), None, tone)
    assert np.abs(image.deep[0, :, 0] - 257.0 * levels).max() <= 1


def test_pillow_reads_the_upper_bits_of_png() -> None:
    image = picture(20, 30)
    with pillow.open(io.BytesIO(image.encode("PNG", bits=16))) as file:
        assert np.array_equal(np.asarray(file), image.deep >> 8)


# BigTIFF, strip by strip.


def write(path: Path, levels: np.ndarray, first: int = 0) -> None:
    """Write a picture with its strips from a byte on that may be far behind the header."""
    height, width, _ = levels.shape
    with path.open("wb") as file:

        def strips() -> Iterator[bytes]:
            file.seek(max(first, file.tell()))
            yield from tiff.strips(levels)

        tiff.write(file, width, height, 8 * levels.itemsize, strips())


@pytest.mark.parametrize("number", [np.uint8, np.uint16])
@pytest.mark.parametrize(("width", "height"), [(1, 1), (7, 16), (33, 50), (300, 129)])
def test_other_libraries_read_the_levels(tmp_path: Path, number: type, width: int, height: int) -> None:
    levels = np.random.Generator(np.random.PCG64(7)).integers(np.iinfo(number).max, size=(height, width, 3))
    levels = levels.astype(number)
    write(tmp_path / "a.tif", levels)
    with tifffile.TiffFile(tmp_path / "a.tif") as file:
        assert file.is_bigtiff
        assert np.array_equal(file.asarray(), levels)
    read = cv2.imread(str(tmp_path / "a.tif"), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(read[..., ::-1], levels)
    if number is np.uint8:  # Pillow has no 16 bits of several channels
        with pillow.open(tmp_path / "a.tif") as picture:
            assert np.array_equal(np.asarray(picture), levels)


def test_places_beyond_4_gib_are_kept(tmp_path: Path) -> None:
    levels = np.arange(40 * 5 * 3, dtype=np.uint8).reshape(40, 5, 3)
    write(tmp_path / "a.tif", levels, 5 * 2**30)  # a hole, which takes no room on the disk
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), levels)
