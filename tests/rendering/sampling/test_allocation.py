"""Which packets get more samples, against the exact optimum and against what is known of them."""

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


def price(doublings: np.ndarray) -> float:
    return float((2.0**doublings).sum())


@pytest.mark.parametrize("share", [0.9, 0.5, 0.2])
def test_it_leaves_the_share_that_is_asked_for(share: float) -> None:
    found = allocate(C, NONE, share, np.inf)
    assert 0.97 * share < error(found) / error(NONE) <= share
    assert found.min() >= 0
    assert found.max() <= DOUBLINGS_A_ROUND


def test_it_is_nearly_as_cheap_as_can_be() -> None:
    """The optimum of Lagrange, n in proportion to c^0.4 but at least 1, in whole numbers or not."""
    found = allocate(C, NONE, 0.5, np.inf)
    low, high = 0.0, 1e6
    for _ in range(100):
        middle = (low + high) / 2
        best = np.clip(middle * C**0.4, 1, 2**DOUBLINGS_A_ROUND)
        low, high = (middle, high) if (C * best**-1.5).sum() > 0.5 * error(NONE) else (low, middle)
    assert best.sum() <= price(found) < best.sum() + 0.4 * (best.sum() - C.size)


@pytest.mark.parametrize("budget", [0.5, 100, 3000])
def test_a_budget_is_kept_and_used(budget: float) -> None:
    spent = price(allocate(C, NONE, 0.0, budget)) - price(NONE)
    assert budget - max(8, 0.05 * budget) <= spent <= budget


def test_packets_keep_what_they_have() -> None:
    old = RANDOM.integers(0, 5, C.shape)
    found = allocate(C, old, 0.5, np.inf)
    assert (found >= old).all()
    assert (found <= old + DOUBLINGS_A_ROUND).all()


def test_what_cannot_be_better_stays() -> None:
    full = np.full(C.shape, MOST_DOUBLINGS)
    assert np.array_equal(allocate(C, full, 0.1, np.inf), full)
    assert np.array_equal(allocate(np.zeros(C.shape), NONE, 0.5, np.inf), NONE)


def test_packets_that_are_alike_do_not_all_grow_at_once() -> None:
    found = allocate(np.ones(C.shape), NONE, 0.8, np.inf)
    assert 0.77 < (2.0 ** (-1.5 * found)).mean() <= 0.8


def halves(guides: float, judges: float) -> Replicates:
    made = Replicates(240, 320, 4)
    made.guides[...], made.judges[...] = guides, judges
    return made


def test_few_samples_are_mixed_with_what_others_of_the_kind_have() -> None:
    made = halves(0, 0)
    made.judges[:, :40], made.guides[0, 0] = 1.0, 8.0
    contrast = np.zeros((60, 80), np.int64)
    contrast[:, :40] = 4
    c = coefficients(made, NONE, contrast)
    assert c[1, :40] == pytest.approx(2 * 4 / 5, rel=1e-3)  # edges, of which the guides see nothing
    assert c[0, 0] == pytest.approx(2 * (8 + 4) / 5, rel=1e-3)
    assert 0 < c[0, 40:].max() < 1e-4  # what none of the quiet ones saw
    many = coefficients(made, NONE + 6, contrast) / 2**9
    assert many[0, 0] == pytest.approx(2 * (64 * 8 + 4) / 68, rel=1e-3)


def test_the_sum_is_what_the_judges_say_where_guides_say_the_same() -> None:
    made = halves(0.3, 0.3)
    contrast, doublings = RANDOM.integers(0, 5, (60, 80)), RANDOM.integers(0, 4, (60, 80))
    c = coefficients(made, doublings, contrast)
    assert (c * 2.0 ** (-1.5 * doublings)).mean() == pytest.approx(0.6, rel=1e-2)
