"""Allocation of samples to packets, compared with the exact optimum and with constructed errors."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.rendering.sampling.allocation import DOUBLINGS_A_ROUND, MOST_DOUBLINGS, allocate, coefficients
from minirt.rendering.sampling.replicates import Replicates

RANDOM = np.random.default_rng(3)
C = RANDOM.lognormal(-8, 1.5, (60, 80))
NONE = np.zeros((60, 80), np.int64)


def error(doublings: np.ndarray) -> float:
    return float((C * 2.0 ** (-1.5 * doublings)).sum())


def cost(doublings: np.ndarray) -> float:
    return float((2.0**doublings).sum())


@pytest.mark.parametrize("share", [0.9, 0.5, 0.2])
def test_the_requested_share_of_the_error_is_left(share: float) -> None:
    allocated = allocate(C, NONE, share, np.inf)
    assert 0.97 * share < error(allocated) / error(NONE) <= share
    assert allocated.min() >= 0
    assert allocated.max() <= DOUBLINGS_A_ROUND


def test_the_cost_is_nearly_the_least() -> None:
    """The optimum by Lagrange multipliers: n in proportion to c^0.4 but at least 1, not rounded to powers of 2."""
    allocated = allocate(C, NONE, 0.5, np.inf)
    low, high = 0.0, 1e6
    for _ in range(100):
        middle = (low + high) / 2
        best = np.clip(middle * C**0.4, 1, 2**DOUBLINGS_A_ROUND)
        low, high = (middle, high) if (C * best**-1.5).sum() > 0.5 * error(NONE) else (low, middle)
    assert best.sum() <= cost(allocated) < best.sum() + 0.4 * (best.sum() - C.size)


@pytest.mark.parametrize("budget", [0.5, 100, 3000])
def test_a_budget_is_kept_and_used(budget: float) -> None:
    spent = cost(allocate(C, NONE, 0.0, budget)) - cost(NONE)
    assert budget - max(8, 0.05 * budget) <= spent <= budget


def test_packets_keep_their_samples() -> None:
    old = RANDOM.integers(0, 5, C.shape)
    allocated = allocate(C, old, 0.5, np.inf)
    assert (allocated >= old).all()
    assert (allocated <= old + DOUBLINGS_A_ROUND).all()


def test_packets_that_cannot_improve_stay() -> None:
    full = np.full(C.shape, MOST_DOUBLINGS)
    assert np.array_equal(allocate(C, full, 0.1, np.inf), full)
    assert np.array_equal(allocate(np.zeros(C.shape), NONE, 0.5, np.inf), NONE)


def test_equal_packets_do_not_all_grow_at_once() -> None:
    allocated = allocate(np.ones(C.shape), NONE, 0.8, np.inf)
    assert 0.77 < (2.0 ** (-1.5 * allocated)).mean() <= 0.8


def halves(guides: float, judges: float) -> Replicates:
    made = Replicates(240, 320, 4)
    made.guides[...], made.judges[...] = guides, judges
    return made


def test_few_samples_are_mixed_with_the_errors_of_the_class() -> None:
    made = halves(0, 0)
    made.judges[:, :40], made.guides[0, 0] = 1.0, 8.0
    contrast = np.zeros((60, 80), np.int64)
    contrast[:, :40] = 4
    c = coefficients(made, NONE, contrast)
    assert c[1, :40] == pytest.approx(2 * 4 / 5, rel=1e-3)  # edges that the guides missed
    assert c[0, 0] == pytest.approx(2 * (8 + 4) / 5, rel=1e-3)
    assert 0 < c[0, 40:].max() < 1e-4  # features that all of the uniform packets may have missed
    many = coefficients(made, NONE + 6, contrast) / 2**9
    assert many[0, 0] == pytest.approx(2 * (64 * 8 + 4) / 68, rel=1e-3)


def test_the_sum_is_that_of_the_judges_if_guides_and_judges_agree() -> None:
    made = halves(0.3, 0.3)
    contrast, doublings = RANDOM.integers(0, 5, (60, 80)), RANDOM.integers(0, 4, (60, 80))
    c = coefficients(made, doublings, contrast)
    assert (c * 2.0 ** (-1.5 * doublings)).mean() == pytest.approx(0.6, rel=1e-2)
