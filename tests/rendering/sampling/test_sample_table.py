"""Tables of sample positions: those of uniform pictures, and references without bias."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from math import inf, sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.kernel.pixels import PACKET_HEIGHT, SUMS, squared_error
from minirt.rendering.frame import COUNTS, SampleTable, positions_of, sample_positions
from minirt.rendering.packing.camera import packet_places
from minirt.rendering.sampling.packets import (
    CLASSES,
    LINES,
    SQUARED_ROUNDING,
    Packets,
    allocate,
    contrast_classes,
    cost,
    estimated_error,
    places_of,
    with_neighbours,
)
from tests.kernel.pictures import TWO
from tests.rendering.sampling.test_auto import HEIGHT, KNOWN, WIDTH, reference, rms
from tests.seeds import seed_of

Array = NDArray[np.float64]

RAYS = 4 * PACKET_HEIGHT
FACTOR = 1.5  # between estimated and true errors of refined pictures


CORNERS = packet_places(RAYS, np.zeros((1, 2)))[0]  # of the pixels of a packet


def by_sample(places: Array, samples: int) -> Array:
    """Return places in their pixels, (k, pixels, samples, 2), of samples that follow each other pixel by pixel."""
    return places.reshape(-1, RAYS, samples, 2) - CORNERS[:, None]


def test_drawn_samples_are_those_of_a_uniform_picture() -> None:
    levels = np.array([0, 3, 7])
    table = SampleTable(levels, RAYS)
    for level in levels:
        drawn = by_sample(table.positions[table.first[level] :][: COUNTS[level]], COUNTS[level])
        assert drawn == pytest.approx(np.broadcast_to(sample_positions(COUNTS[level]), drawn.shape), abs=1e-14)


def test_plans_name_rows_of_the_table_and_references_differ() -> None:
    table = SampleTable(np.arange(12), RAYS)
    levels = np.arange(600) % 12
    plan = table.plan(levels.astype(np.uint8))
    assert np.array_equal(plan[:, 1], COUNTS[levels])
    assert (plan[:, 2] > 0).all()
    assert not SampleTable(np.arange(12), RAYS, with_references=False).plan(levels)[:, 2].any()
    ends = plan[:, 2] + 2 * plan[:, 1]
    assert ends.max() <= len(table.positions)
    for _, number, first in plan[:20]:
        references = by_sample(table.positions[first:][: 2 * number], number)
        assert references.min() > -1e-14
        assert references.max() < 1
        assert not np.isclose(*references).all(axis=(1, 2)).any()


def test_references_have_no_bias() -> None:
    """The mean of a function with an edge over many shifts is its mean over the pixel."""
    positions = positions_of(1, 0, 2000, RAYS, with_places=False) - CORNERS
    assert (positions @ (0.3, 0.8) < 0.4).mean() == pytest.approx(0.5 - 0.3 / 2 / 0.8, abs=0.003)


# Estimator of the squared error of a picture, on packets with constructed errors, and wrong estimators.


TRIALS, SPREAD = 500, 0.1  # of the references around the light


def packet_estimates(second_reference: Callable[[Array, Array], Array]) -> tuple[Array, float]:
    """Estimates by the kernel of one packet's squared error, and the true one; the function of the first reference and
    of an independent one is the second."""
    random = np.random.default_rng(4)
    light = random.uniform(0.4, 0.6, 3 * RAYS)
    drawn = light + random.normal(0, 0.03, 3 * RAYS)
    found = []
    for _ in range(TRIALS):
        one, other = light + random.uniform(-SPREAD, SPREAD, (2, 3 * RAYS))
        sums = np.zeros(SUMS)
        for number, values in enumerate((drawn, one, second_reference(one, other))):
            sums[9 + number * 3 * RAYS :][: 3 * RAYS] = values
        found.append(squared_error(sums, 9, PACKET_HEIGHT, 4, RAYS))
    return np.array(found), float(((drawn - light) ** 2).sum())


def is_true(found: Array, true: float) -> bool:
    """Whether the mean of estimates is the true value, within four of its standard errors."""
    return bool(abs(found.mean() - true) < 4 * found.std() / np.sqrt(len(found)))


def test_independent_references_have_the_squared_error_as_the_mean_of_their_product() -> None:
    assert is_true(*packet_estimates(lambda one, other: other))


# Allocation of samples to classes of packets, compared with the exact optimum and with constructed errors.


RANDOM = np.random.default_rng(3)
COEFFICIENTS = RANDOM.lognormal(-8, 3, CLASSES)
SIZES = RANDOM.integers(10, 5000, CLASSES)
WHOLE = float(SIZES @ COEFFICIENTS)


def error(samples: Array) -> float:
    return float((SIZES * COEFFICIENTS) @ samples**-1.5)


@pytest.mark.parametrize("share", [0.9, 0.5, 0.01, 1e-4])
def test_the_requested_error_is_left_at_the_least_cost(share: float) -> None:
    """The optimum by Lagrange multipliers: n in proportion to c^0.4 but at least 1."""
    allocated = allocate(COEFFICIENTS, SIZES, share * WHOLE, inf, 1.0)
    assert 0.97 * share < error(allocated) / WHOLE <= share
    low, high = 0.0, 1e9
    for _ in range(100):
        middle = (low + high) / 2
        best = np.maximum(middle * COEFFICIENTS**0.4, 1)
        low, high = (middle, high) if error(best) > share * WHOLE else (low, middle)
    assert allocated == pytest.approx(best, rel=0.03)


@pytest.mark.parametrize("budget", [100.0, 3000.0, 1e6])
def test_a_budget_is_kept_and_used(budget: float) -> None:
    assert 0.9 * budget < cost(allocate(COEFFICIENTS, SIZES, 0.0, budget, 1.0), SIZES) <= budget


def learned(classes: Array, errors: Array) -> Packets:
    """Return packets of which all with one sample were probed."""
    packets = Packets(PACKET_HEIGHT, 4 * len(classes), 4)
    packets.learn(classes.astype(np.uint8)[None], np.arange(len(classes)), errors)
    return packets


def test_equal_classes_get_uniform_samples_and_others_what_is_cheaper() -> None:
    classes = np.repeat(np.arange(CLASSES), 900)
    even, steep = (learned(classes, c) for c in (np.full(len(classes), 0.01), 1e-3 * 4.0 ** (classes - 4.0)))
    assert np.ptp(even.plan(9.0)) < 0.15 * even.plan(9.0).mean()  # what is expected weighs a little
    assert np.ptp(steep.plan(9.0)) > steep.plan(9.0).mean()
    for packets in (even, steep):
        assert packets.bound(packets.plan(9.0)) <= 9.0 * (1 + 1e-9)
        assert packets.plan(9.0).max() <= 20 * packets.plan(9.0).mean()
        assert (packets.plan(1e9) == 1).all()


def test_a_packet_is_at_most_two_classes_below_its_neighbours() -> None:
    random = np.random.default_rng(seed_of("classes"))
    classes = np.where(random.random((9, 7)) < 0.1, random.integers(CLASSES, size=(9, 7)), 0).astype(np.uint8)
    found = with_neighbours(classes)
    for y, x in np.ndindex(classes.shape):
        around = classes[max(y - 1, 0) : y + 2, max(x - 1, 0) : x + 2]
        assert found[y, x] == max(int(classes[y, x]), int(around.max()) - 2)


def test_places_keep_the_mean_number_of_samples() -> None:
    samples = np.array([1.0, 1.3, 5.0, 7.0, 100.0, 4096.0])
    dither = (np.arange(1000) + 0.5) / 1000
    levels = (places_of(samples)[:, None] + dither).astype(int)
    assert COUNTS[levels].mean(axis=1) == pytest.approx(samples, rel=0.07)
    assert (COUNTS[levels[0]] == 1).all()


# Contrast of packets, and the estimated error of refined pictures.


Pixels = NDArray[np.uint8]


# Contrast classes of packets, compared with a loop over the pixels.


def thrice(job: Callable[[], object]) -> None:
    for _ in range(3):
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
    assert np.array_equal(contrast_classes(pixels, packet_width, thrice), by_loop(pixels, packet_width))


# The estimated error of refined pictures, compared with pictures of many samples.


@pytest.mark.parametrize("name", ["all", "demo", "subject", "everything", "random"])
def test_the_estimate_is_near_the_true_error(name: str) -> None:
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    assert TWO.render(KNOWN[name], pixels)
    fewer = 1
    for samples in (4, 16):
        before = pixels.copy()
        assert TWO.render(KNOWN[name], pixels, samples, edges_only=True)
        estimate = estimated_error(before, pixels, fewer, samples)
        assert estimate is not None
        assert 1 / 1.5 < estimate / rms(pixels[..., 2::-1] / 255 - reference(name)) < 1.5
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


def test_an_estimate_that_is_no_longer_wanted_ends_after_a_strip(monkeypatch: pytest.MonkeyPatch) -> None:
    lines: list[int] = []  # of which the rounding error was computed between two questions
    target = "minirt.rendering.sampling.packets.rounding_error"
    monkeypatch.setattr(target, lambda strip, *_, **__: lines.append(len(strip)) or 0.5)
    assert estimated_error(TALL[0], TALL[0], 1, 4, tone="srgb") == pytest.approx(0.5)
    assert lines == [LINES, LINES, LINES, 5]
    for asked in range(4):
        questions = count()
        assert estimated_error(*TALL, 1, 4, lambda: next(questions) < asked) is None  # noqa: B023
        assert next(questions) == asked + 1
