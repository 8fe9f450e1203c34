"""Allocation of samples to classes of packets, compared with the exact optimum and with constructed errors."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.rendering.sampling.contrast import CLASSES
from minirt.rendering.sampling.packets import PRIOR, allocate, coefficients, places_of, squared_error
from minirt.rendering.sampling.sample_table import COUNTS

RANDOM = np.random.default_rng(3)
C = RANDOM.lognormal(-8, 3, CLASSES)
PACKETS = np.zeros((CLASSES, len(COUNTS)), np.int64)
PACKETS[:, 0] = RANDOM.integers(10, 5000, CLASSES)
WHOLE = squared_error(C, PACKETS)

Array = NDArray[np.float64]


def error(samples: Array, packets: NDArray[np.int64] = PACKETS) -> float:
    return float((packets * C[:, None] * samples**-1.5).sum())


def cost(samples: Array, packets: NDArray[np.int64] = PACKETS) -> float:
    return float((packets * samples)[samples > COUNTS].sum())


@pytest.mark.parametrize("share", [0.9, 0.5, 0.01, 1e-5])
def test_the_requested_error_is_left_at_the_least_cost(share: float) -> None:
    """The optimum by Lagrange multipliers: n in proportion to c^0.4 but at least 1."""
    allocated = allocate(C, PACKETS, share * WHOLE, np.inf)
    assert 0.97 * share < error(allocated) / WHOLE <= share
    low, high = 0.0, 1e9
    for _ in range(100):
        middle = (low + high) / 2
        best = np.maximum(middle * C**0.4, 1)[:, None] * np.ones(len(COUNTS))
        low, high = (middle, high) if error(best) > share * WHOLE else (low, middle)
    assert cost(allocated) < 1.02 * cost(best)


@pytest.mark.parametrize("budget", [0.5, 100.0, 3000.0, 1e6])
def test_a_budget_is_kept_and_used(budget: float) -> None:
    spent = cost(allocate(C, PACKETS, 0.0, budget))
    assert spent <= budget
    assert spent > 0.9 * budget or budget < PACKETS[:, 0].max()  # a class is drawn again as a whole or not at all


def test_packets_keep_their_samples() -> None:
    packets = RANDOM.integers(0, 50, PACKETS.shape)
    allocated = allocate(C, packets, 0.5 * squared_error(C, packets), np.inf)
    assert (allocated >= COUNTS).all()
    assert error(allocated, packets) <= 0.5 * squared_error(C, packets)


def test_coefficients_are_those_of_constructed_errors() -> None:
    classes, counts = RANDOM.integers(0, CLASSES, 90_000), RANDOM.choice(COUNTS[:12], 90_000)
    errors = C[classes] * counts**-1.5 * RANDOM.normal(1, 3, 90_000)  # some of the products are negative
    found = coefficients(classes, counts, errors)
    large = 1e-3 * C.max() < C
    assert found[large] == pytest.approx(C[large], rel=0.2)
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
