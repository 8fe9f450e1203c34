"""The estimated error of refined pictures, compared with pictures of many samples."""

from __future__ import annotations

from itertools import count
from math import sqrt

import numpy as np
import pytest

from minirt.rendering.sampling.error_estimate import ROUNDING, STRIP, estimated_error
from tests.kernel.pictures import TWO
from tests.rendering.sampling.test_auto import FACTOR, HEIGHT, KNOWN, WIDTH, reference, rms


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


TALL = np.random.default_rng(1).integers(0, 256, (2, 3 * STRIP + 5, 7, 4), np.uint8)
TALL[..., 3] = 255


def test_the_estimate_covers_all_strips() -> None:
    squared = ((TALL[0].astype(float) - TALL[1])[..., :3] ** 2).mean()
    assert estimated_error(*TALL, 1, 4) == pytest.approx(sqrt(squared / 9 + ROUNDING) / 255)


def test_an_estimate_that_is_no_longer_wanted_ends_after_a_strip() -> None:
    for asked in range(4):
        questions = count()
        assert estimated_error(*TALL, 1, 4, lambda: next(questions) < asked) is None  # noqa: B023
        assert next(questions) == asked + 1
