"""Which packets get more samples.

With n samples, one in each of n strips, the squared error of a pixel with an edge is about c / n^1.5 (Mitchell,
Consequences of stratified sampling in graphics, 1996); the cheapest way to a sum of these, with n as the price, gives
each packet n in proportion to c^0.4. c is what the guides of a packet say, and as long as it has few samples as much
what its neighbours' say: an edge that no guide saw is often seen beside it. What they overlook altogether is charged to
all quiet packets alike, by their judges.
"""

from __future__ import annotations

import numpy as np

from minirt.rendering.replicates import Replicates

FALL = 1.5  # squared error falls as this power of the number of samples
FASTEST = 3  # doublings in a round, after which more is known
PRIOR = 4.0
GOLDEN = (5**0.5 - 1) / 2
UNSEEN = 1 / 16
SEARCH = 14  # halvings of the interval of prices


def coefficients(halves: Replicates, doublings: np.ndarray, contrast: np.ndarray) -> np.ndarray:
    """c for every packet with 2^doublings samples and of some class of contrast."""
    fallen, samples = 2.0 ** (FALL * doublings), 2.0**doublings
    own = 2 * halves.guides * fallen
    alike = 2 * mean_of_alike(halves.judges, doublings * 8 + contrast, UNSEEN / samples**2) * fallen
    known: np.ndarray = (samples * own + PRIOR * alike) / (samples + PRIOR)
    return known


def mean_of_alike(values: np.ndarray, kinds: np.ndarray, one_more: np.ndarray) -> np.ndarray:
    """For each value the mean of all of its kind, as if these had `one_more` in their sum."""
    members = kinds.ravel()
    counts = np.maximum(np.bincount(members), 1)
    means = np.bincount(members, values.ravel()) / counts
    found: np.ndarray = means[members].reshape(values.shape) + one_more / counts[members].reshape(values.shape)
    return found


def allocate(c: np.ndarray, doublings: np.ndarray, share: float, most: int, budget: float) -> np.ndarray:
    """Doublings, at most `most`, by which a `share` of the sum of squares is left, or as many as there is a budget for,
    in samples of packets; never fewer than before."""
    with np.errstate(divide="ignore"):
        ideal = np.log2(c) / (FALL + 1) + (np.arange(c.size) * GOLDEN % 1 - 0.5).reshape(c.shape)
    steps = np.arange(most + 1)
    left_after, price_of = 2.0 ** (-FALL * steps), 2.0**steps
    left_now, price_now = float((c * left_after[doublings]).sum()), float(price_of[doublings].sum())
    limit = np.minimum(doublings + FASTEST, most)

    def at(level: float) -> np.ndarray:
        wanted: np.ndarray = np.clip(np.rint(ideal - level), doublings, limit).astype(np.int64)
        return wanted

    worth = (ideal - doublings)[c > 0]
    if not len(worth):
        return doublings
    low, high = worth.min() - FASTEST - 1, worth.max() + 1  # everything grows as fast as it may, nothing grows
    for _ in range(SEARCH):
        middle = (low + high) / 2
        new = at(middle)
        is_enough = (c * left_after[new]).sum() <= share * left_now
        if is_enough or price_of[new].sum() - price_now > budget:
            low = middle
        else:
            high = middle
    affordable = price_of[at(low)].sum() - price_now <= budget
    return at(low if affordable else high)
