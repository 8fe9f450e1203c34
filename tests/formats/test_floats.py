"""Files of floating-point numbers hold the light: OpenEXR's own library and OpenCV read them back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.formats import floats
from minirt.materials.radiance import read_header, read_pixels
from minirt.rendering.image import Image
from tests.formats.pictures import SIZES, light, picture

exr = pytest.importorskip("OpenEXR")
cv2 = pytest.importorskip("cv2")


def read_exr(path: Path) -> np.ndarray:
    """The pixels of an EXR file, by OpenEXR."""
    with exr.File(str(path)) as file:
        pixels: np.ndarray = file.channels()["RGB"].pixels
        return pixels.copy()


def read_opencv(path: Path) -> np.ndarray:
    """The pixels of a file, by OpenCV, whose order is blue, green, red."""
    pixels: np.ndarray = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., ::-1]
    return pixels


@pytest.mark.parametrize(("name", "read"), [("a.exr", read_exr), ("a.pfm", read_opencv)])
@pytest.mark.parametrize("size", SIZES)
def test_float32_is_read_back_to_the_bit(
    tmp_path: Path, name: str, read: Callable[[Path], np.ndarray], size: tuple[int, int]
) -> None:
    picture(*size).save(tmp_path / name)
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


@pytest.mark.parametrize("name", ["a.exr", "a.hdr", "a.pfm"])
def test_a_picture_without_light_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(RenderError, match="32 bits need linear light, and this picture has levels of 8 bits alone"):
        Image(np.zeros((2, 2, 3), np.uint8)).save(tmp_path / name)
    assert not list(tmp_path.iterdir())
