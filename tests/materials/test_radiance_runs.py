"""Older encoding of Radiance pictures: scanlines written in all ways that it allows. Memory that a picture takes."""

from __future__ import annotations

import tracemalloc
from random import Random

import numpy as np
import pytest

from minirt.materials import radiance
from minirt.materials.radiance import read_header, read_pixels, read_whole_pixels


def encode(row: list[bytes], random: Random) -> bytes:
    """Write a scanline, with each run of equal pixels cut at random into pixels, repeats and repeats of none."""
    data, done = b"", 0
    while done < len(row):
        data += row[done]
        equal = next((at for at in range(done, len(row)) if row[at] != row[done]), len(row)) - done
        repeats = random.randrange(equal)
        done += 1 + repeats
        if done < len(row) or repeats:
            digits = [repeats >> shift & 255 for shift in (0, 8, 16, 24)]
            while digits and not digits[-1] and (done == len(row) or random.random() < 0.7):
                digits.pop()  # of the last pixels nothing may follow the digit that fills the scanline
            data += b"".join(bytes([1, 1, 1, digit]) for digit in digits)
    return data


def test_all_ways_to_write_a_scanline_give_its_pixels() -> None:
    random = Random(5)
    for length in [*range(1, 12), 255, 256, 257, 1000, 70_000]:
        for _ in range(20 if length < 2000 else 2):
            row: list[bytes] = []
            while len(row) < length:
                row += [bytes([*random.randbytes(3), 200])] * random.choice([1, 2, 3, length // 2 + 1])
            row = row[:length]
            row = [pixel if pixel[:3] != b"\1\1\1" else b"\2\1\1\1" for pixel in row]
            data = encode(row, random)
            pixels = np.zeros((length, 4), np.uint8)
            assert read_whole_pixels(b"--" + data + b"rest", 2, pixels) == 2 + len(data)
            assert pixels.tobytes() == b"".join(row)


def peak_memory(data: bytes) -> int:
    """Return the most bytes that reading the light of a file takes at a moment."""
    header = read_header(data)
    tracemalloc.start()
    read_pixels(data, header)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


def test_light_takes_little_more_memory_than_it_has(monkeypatch: pytest.MonkeyPatch) -> None:
    side = 512
    row = b"\2\2" + side.to_bytes(2, "big") + b"".join(bytes([128 + side // 8, 100]) * 8 for _ in "rgbe")
    data = b"#?RADIANCE\n\n-Y %d +X %d\n" % (side, side) + row * side
    light = read_pixels(data, read_header(data))
    assert (light == 100 / 256 * 2.0 ** (100 - 128)).all()
    assert peak_memory(data) > 3 * light.nbytes  # all pixels at once, in double precision
    monkeypatch.setattr(radiance, "PIXELS_AT_ONCE", 2**10)
    assert peak_memory(data) < 1.5 * light.nbytes  # mantissas and exponents take a third of it
    assert np.array_equal(read_pixels(data, read_header(data)), light)
