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
FASTEST = 2  # doublings in a round, after which more is known
SEARCH = 24  # halvings of the interval of prices


def coefficients(halves: Replicates, doublings: np.ndarray, goal: float) -> np.ndarray:
    """c for every packet with 2^doublings samples; `goal` is the mean of squares that is wanted."""
    fallen = 2.0 ** (FALL * doublings)
    own = 2 * halves.guides * fallen
    samples = 2.0**doublings
    seen = (samples * own + beside(own)) / (samples + 1)
    quiet = seen < goal * halves.judged / halves.judges.size * fallen
    overlooked = np.zeros(own.shape)
    for each in np.unique(doublings[quiet]):
        group = quiet & (doublings == each)
        overlooked[group] = 2 * halves.judges[group].mean() * 2.0 ** (FALL * each)
    return seen + overlooked


def beside(values: np.ndarray) -> np.ndarray:
    """The mean of the eight neighbours of each; those outside are 0."""
    rows, columns = values.shape
    padded = np.pad(values, 1)
    lines = padded[:, :-2] + padded[:, 1:-1] + padded[:, 2:]
    around: np.ndarray = (lines[:-2] + lines[1:-1] + lines[2:] - values) / 8
    return around


def allocate(c: np.ndarray, doublings: np.ndarray, share: float, most: int, budget: float) -> np.ndarray:
    """Doublings, at most `most`, by which a `share` of the sum of squares is left, or as many as there is a budget for,
    in samples of packets; never fewer than before."""
    with np.errstate(divide="ignore"):
        ideal = np.log2(c) / (FALL + 1)
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
