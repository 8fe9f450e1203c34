"""Contrast classes of packets, compared with a loop over the pixels."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.kernel.stored_light import PACKET_HEIGHT
from minirt.rendering.sampling.contrast import CLASSES, contrast_classes

Pixels = NDArray[np.uint8]


def run(jobs: list[Callable[[], object]]) -> None:
    for job in reversed(jobs):
        job()


def by_loop(pixels: Pixels, packet_width: int) -> NDArray[np.int64]:
    height, width, _ = pixels.shape
    greatest = np.zeros((-(-height // PACKET_HEIGHT), -(-width // packet_width)), np.int64)
    for y in range(height):
        for x in range(width):
            for b, a in ((y, x + 1), (y + 1, x), (y, x - 1), (y - 1, x)):
                if 0 <= b < height and 0 <= a < width:
                    difference = np.abs(pixels[y, x].astype(int) - pixels[b, a]).max()
                    packet = y // PACKET_HEIGHT, x // packet_width
                    greatest[packet] = max(greatest[packet], difference)
    return np.ceil(np.log2(greatest + 1)).astype(int)


@pytest.mark.parametrize("packet_width", [4, 8])
@pytest.mark.parametrize("size", [(1, 1), (3, 50), (8, 16), (29, 31), (5 * PACKET_HEIGHT + 1, 9)])
@pytest.mark.parametrize("spread", [0, 1, 7, 255])
def test_classes_are_those_of_the_greatest_difference(size: tuple[int, int], packet_width: int, spread: int) -> None:
    random = np.random.default_rng(spread)
    pixels = np.full((*size, 4), 255, np.uint8)
    few = random.random(size) < 0.1  # so that some packets have one pixel that differs
    pixels[..., :3] = 90
    pixels[few, :3] = random.integers(90 - spread // 3, 91 + spread // 2, (np.count_nonzero(few), 3))
    classes, counts = contrast_classes(pixels, packet_width, run, threads=3)
    assert np.array_equal(classes, by_loop(pixels, packet_width))
    assert np.array_equal(counts, np.bincount(classes.ravel(), minlength=CLASSES))
