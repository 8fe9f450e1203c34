"""BigTIFF files are read back by tifffile, Pillow and OpenCV."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.formats import tiff

cv2 = pytest.importorskip("cv2")  # `make lowest` is without
tifffile = pytest.importorskip("tifffile")


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
