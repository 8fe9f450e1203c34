"""Tables of sample positions: those of uniform pictures, and references without bias."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from math import sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.kernel.frame import REFERENCE_SAMPLES
from minirt.kernel.pixels import ESTIMATE, PACKET_HEIGHT, SUMS, squared_error
from minirt.rendering.frame import COUNTS, SampleTable, random_shifts, sample_positions
from minirt.rendering.sampling.packets import (
    CLASSES,
    LINES,
    PRIOR,
    SQUARED_ROUNDING,
    Packets,
    allocate,
    coefficients,
    contrast_classes,
    estimated_error,
    places_of,
)
from minirt.rendering.sampling.packets import squared_error as sum_of_errors
from tests.kernel.pictures import TWO
from tests.rendering.sampling.test_auto import FACTOR, HEIGHT, KNOWN, WIDTH, reference, rms

RAYS = 4 * PACKET_HEIGHT


def test_drawn_samples_are_those_of_a_uniform_picture() -> None:
    levels = np.array([0, 3, 7])
    table = SampleTable(levels, RAYS)
    for level in levels:
        drawn = table.positions[table.first[level] :][: COUNTS[level]]
        assert np.array_equal(drawn, np.broadcast_to(sample_positions(COUNTS[level])[:, None], drawn.shape))


def test_plans_name_rows_of_the_table_and_references_differ() -> None:
    table = SampleTable(np.arange(12), RAYS)
    levels = np.arange(600) % 12
    plan = table.plan(levels.astype(np.uint8), levels % 2 > 0)
    assert np.array_equal(plan[:, 1], COUNTS[levels])
    assert np.array_equal(plan[:, 2] > 0, levels % 2 > 0)
    ends = plan[:, 2] + 2 * REFERENCE_SAMPLES * plan[:, 1] * (plan[:, 2] > 0)
    assert ends.max() <= len(table.positions)
    assert (table.positions >= 0).all()
    assert (table.positions < 1).all()
    for _, number, first in plan[plan[:, 2] > 0][:20]:
        one, other = table.positions[first:][: 2 * REFERENCE_SAMPLES * number].reshape(2, -1, RAYS, 2)
        assert not np.isclose(one, other).all(axis=(0, 2)).any()


def test_references_have_no_bias() -> None:
    """The mean of a function with an edge over many shifts is its mean over the pixel."""
    shifts = random_shifts(2000, RAYS).reshape(-1, 2)
    positions = (sample_positions(REFERENCE_SAMPLES)[:, None] + shifts) % 1.0
    assert (positions @ (0.3, 0.8) < 0.4).mean() == pytest.approx(0.5 - 0.3 / 2 / 0.8, abs=0.003)


# Estimator of the squared error of a picture, on packets with constructed errors, and wrong estimators.


Array = NDArray[np.float64]

TRIALS, SPREAD = 500, 0.1  # of the references around the light
SIZES, C = (20_000, 900, 100), (1e-6, 0.01, 0.3)  # of classes 0, 4 and 7, and their squared errors with one sample
CLASSES_USED = (0, 4, 7)
TRUE = float(np.dot(SIZES, C))


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
            sums[number * ESTIMATE :][: 3 * RAYS] = values
        found.append(squared_error(sums, PACKET_HEIGHT, 4, RAYS))
    return np.array(found), float(((drawn - light) ** 2).sum())


def is_true(found: Array, true: float) -> bool:
    """Whether the mean of estimates is the true value, within four of its standard errors."""
    return bool(abs(found.mean() - true) < 4 * found.std() / np.sqrt(len(found)))


def test_independent_references_have_the_squared_error_as_the_mean_of_their_product() -> None:
    assert is_true(*packet_estimates(lambda one, other: other))


def probed_picture(samples_squared: bool = False, ignored: int = -1) -> float:
    """Estimate by probes the error of a picture in which the packets of class 7 got 4 samples, the others one."""
    random = np.random.default_rng(5)
    packets = Packets(PACKET_HEIGHT, 4 * sum(SIZES), 4)
    classes = np.repeat(CLASSES_USED, SIZES).astype(np.uint8)
    packets.classify(classes, np.bincount(classes, minlength=CLASSES))
    edges = packets.members(7)
    packets.drawn(edges, np.full(len(edges), 3, np.uint8))
    for of_class, c in zip(CLASSES_USED, C, strict=True):
        if of_class != ignored:
            probes = packets.members(of_class)[:100]
            samples = 4.0 if of_class == 7 else 1.0
            c = c / samples if samples_squared else c  # noqa: PLW2901
            packets.probed(probes, c * samples**-1.5 * random.exponential(1, len(probes)))
    return packets.total()


LEFT = TRUE - SIZES[2] * C[2] * (1 - 4**-1.5)


def test_the_error_of_a_picture_is_that_of_its_classes() -> None:
    assert probed_picture() == pytest.approx(LEFT, rel=0.2)


def test_an_ignored_class_is_expected_from_the_others() -> None:
    """A class without probes still counts, by its contrast."""
    assert probed_picture(ignored=7) > 0.5 * SIZES[2] * C[2] * 4**-1.5


# Allocation of samples to classes of packets, compared with the exact optimum and with constructed errors.


RANDOM = np.random.default_rng(3)
COEFFICIENTS = RANDOM.lognormal(-8, 3, CLASSES)
NUMBERS = np.zeros((CLASSES, len(COUNTS)), np.int64)
NUMBERS[:, 0] = RANDOM.integers(10, 5000, CLASSES)
WHOLE = sum_of_errors(COEFFICIENTS, NUMBERS)


def error(samples: Array, packets: NDArray[np.int64] = NUMBERS) -> float:
    return float((packets * COEFFICIENTS[:, None] * samples**-1.5).sum())


def cost(samples: Array, packets: NDArray[np.int64] = NUMBERS) -> float:
    return float((packets * samples)[samples > COUNTS].sum())


@pytest.mark.parametrize("share", [0.9, 0.5, 0.01, 1e-5])
def test_the_requested_error_is_left_at_the_least_cost(share: float) -> None:
    """The optimum by Lagrange multipliers: n in proportion to c^0.4 but at least 1."""
    allocated = allocate(COEFFICIENTS, NUMBERS, share * WHOLE, np.inf)
    assert 0.97 * share < error(allocated) / WHOLE <= share
    low, high = 0.0, 1e9
    for _ in range(100):
        middle = (low + high) / 2
        best = np.maximum(middle * COEFFICIENTS**0.4, 1)[:, None] * np.ones(len(COUNTS))
        low, high = (middle, high) if error(best) > share * WHOLE else (low, middle)
    assert cost(allocated) < 1.02 * cost(best)


@pytest.mark.parametrize("budget", [0.5, 100.0, 3000.0, 1e6])
def test_a_budget_is_kept_and_used(budget: float) -> None:
    spent = cost(allocate(COEFFICIENTS, NUMBERS, 0.0, budget))
    assert spent <= budget
    assert spent > 0.9 * budget or budget < NUMBERS[:, 0].max()  # a class is drawn again as a whole or not at all


def test_packets_keep_their_samples() -> None:
    packets = RANDOM.integers(0, 50, NUMBERS.shape)
    allocated = allocate(COEFFICIENTS, packets, 0.5 * sum_of_errors(COEFFICIENTS, packets), np.inf)
    assert (allocated >= COUNTS).all()
    assert error(allocated, packets) <= 0.5 * sum_of_errors(COEFFICIENTS, packets)


def test_coefficients_are_those_of_constructed_errors() -> None:
    classes, counts = RANDOM.integers(0, CLASSES, 90_000), RANDOM.choice(COUNTS[:12], 90_000)
    errors = COEFFICIENTS[classes] * counts**-1.5 * RANDOM.normal(1, 3, 90_000)  # some of the products are negative
    found = coefficients(classes, counts, errors)
    large = 1e-3 * COEFFICIENTS.max() < COEFFICIENTS
    assert found[large] == pytest.approx(COEFFICIENTS[large], rel=0.2)
    assert found.min() > 0


def test_a_class_without_probes_is_expected_to_have_the_square_of_its_contrast() -> None:
    classes = np.repeat([3, 4, 5], 1000)
    found = coefficients(classes, np.ones(3000), 4.0**classes)
    assert found == pytest.approx(4.0 ** np.arange(CLASSES))
    few = coefficients(np.array([7]), np.ones(1), np.zeros(1))
    assert few.max() > 0
    one = coefficients(np.array([2, 7]), np.ones(2), np.array([0.0, 1.0]))
    assert one[7] == pytest.approx((1 + PRIOR * 4.0**7 / (4.0**7 + 4.0**2)) / (1 + PRIOR))


def test_places_keep_the_mean_number_of_samples() -> None:
    samples = np.array([1.0, 1.3, 5.0, 7.0, 100.0, 65536.0])
    dither = (np.arange(1000) + 0.5) / 1000
    levels = (places_of(samples)[:, None] + dither).astype(int)
    assert COUNTS[levels].mean(axis=1) == pytest.approx(samples, rel=0.07)
    assert (COUNTS[levels[0]] == 1).all()


# Contrast of packets, and the estimated error of refined pictures.


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
        assert TWO.render(KNOWN[name], pixels, samples, edges_only=True)
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
