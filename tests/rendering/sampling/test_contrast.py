"""Contrast of packets, and the estimated error of refined pictures."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from math import sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering.sampling.contrast import (
    CLASSES,
    LINES,
    SQUARED_ROUNDING,
    contrast_classes,
    estimated_error,
)
from tests.kernel.pictures import TWO
from tests.rendering.sampling.test_auto import FACTOR, HEIGHT, KNOWN, WIDTH, reference, rms

Pixels = NDArray[np.uint8]


# Contrast classes of packets, compared with a loop over the pixels.


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


# The estimated error of refined pictures, compared with pictures of many samples.


@pytest.mark.parametrize("name", ["all", "demo", "subject", "everything", "random"])
def test_the_estimate_is_near_the_true_error(name: str) -> None:
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    assert TWO.render(KNOWN[name], pixels)
    fewer = 1
    for samples in (4, 16):
        before = pixels.copy()
        assert TWO.refine(KNOWN[name], pixels, samples)
        estimate = estimated_error(before, pixels, fewer, samples)
        assert estimate is not None
        assert 1 / FACTOR < estimate / rms(pixels[..., 2::-1] / 255 - reference(name)) < FACTOR
        fewer = samples


def test_a_picture_that_does_not_change_has_the_error_of_rounding() -> None:
    pixels = np.full((9, 7, 4), 200, np.uint8)
    assert estimated_error(pixels, pixels, 1, 4) == pytest.approx(sqrt(1 / 12) / 255)


def test_large_differences_do_not_overflow() -> None:
    black, white = np.zeros((9, 7, 4), np.uint8), np.full((9, 7, 4), 255, np.uint8)
    black[..., 3] = 255
    assert estimated_error(black, white, 1, 4) == pytest.approx(1 / 3, rel=1e-4)
    assert estimated_error(white, black, 4, 4) == pytest.approx(sqrt(1 / 2), rel=1e-4)


TALL = np.random.default_rng(1).integers(0, 256, (2, 3 * LINES + 5, 7, 4), np.uint8)
TALL[..., 3] = 255


def test_the_estimate_covers_all_strips() -> None:
    squared = ((TALL[0].astype(float) - TALL[1])[..., :3] ** 2).mean()
    assert estimated_error(*TALL, 1, 4) == pytest.approx(sqrt(squared / 9 + SQUARED_ROUNDING) / 255)


def test_an_estimate_that_is_no_longer_wanted_ends_after_a_strip() -> None:
    for asked in range(4):
        questions = count()
        assert estimated_error(*TALL, 1, 4, lambda: next(questions) < asked) is None  # noqa: B023
        assert next(questions) == asked + 1
