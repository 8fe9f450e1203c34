"""Texts of PNG files: none takes more memory than it may have."""

from __future__ import annotations

import tracemalloc
import zlib

import numpy as np
import pytest

from minirt.formats import png

PIXEL = np.zeros((1, 1, 3), np.uint8)
KEY = "a scene"
LONGEST = 1000


def peak_of(data: bytes) -> int:
    """Return the bytes of memory that reading a text takes, which is too long."""
    tracemalloc.start()
    try:
        with pytest.raises(png.PngError, match="larger than"):
            png.text(data, KEY, LONGEST)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_text_that_is_too_long_is_not_decompressed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The planted reader decompresses all of a text before it looks at the size."""
    size = 16 * 2**20
    data = png.encode(PIXEL, {KEY: "0" * size})
    assert len(data) < size // 100
    assert peak_of(data) < size // 10

    class Unbounded:
        def decompress(self, text: bytes, _longest: int) -> bytes:
            return zlib.decompress(text)

    monkeypatch.setattr(png.zlib, "decompressobj", Unbounded)
    assert peak_of(data) > size


@pytest.mark.parametrize("size", [0, 1, LONGEST])
def test_a_text_as_long_as_allowed_is_read(size: int) -> None:
    assert png.text(png.encode(PIXEL, {KEY: "0" * size}), KEY, LONGEST) == b"0" * size
