"""Which packets get more samples.

Where n samples lie evenly in a pixel with an edge, the squared error is about c / n^1.5 (Mitchell, Consequences of
stratified sampling in graphics, 1996). The cheapest way to a sum of such errors, with n as the price, gives each packet
a number in proportion to c^0.4.

c is what the guides of a packet say; while it has few samples they know little. So it is mixed with what the judges say
of all packets with as many samples and as much contrast: in a packet with an edge, c is not 0 because its halves happen
to agree. And since what none of them saw may be there all the same, one sample more than they have counts as if it
differed.
"""

from __future__ import annotations

import numpy as np

from minirt.rendering.frame_arguments import GOLDEN_RATIO
from minirt.rendering.sampling.replicates import Replicates

ERROR_EXPONENT = 1.5  # squared error falls as this power of the number of samples
CONTRASTS = (1, 4, 16, 64)  # levels of 255; packets that differ by as many of them are alike
PRIOR = 4.0  # samples that the others of its kind count as in a packet
UNSEEN_ERROR = (
    1 / 16
)  # sum of squares of a pixel that differs by a half in one of three colours, / 4 for the mean of two halves
MOST_DOUBLINGS = 15  # doublings: 65536 samples in both halves
DOUBLINGS_A_ROUND = 3  # doublings in a round
BISECTIONS = 14  # halvings of the interval of levels


def coefficients(halves: Replicates, doublings: np.ndarray, contrast: np.ndarray) -> np.ndarray:
    """c of every packet, which has 2^doublings samples in each half and differs by so many of `CONTRASTS`."""
    samples = 2.0**doublings
    kinds = doublings * (len(CONTRASTS) + 1) + contrast
    counts = np.bincount(kinds.ravel())
    judges = np.bincount(kinds.ravel(), halves.judges.ravel())
    alike = judges[kinds] + UNSEEN_ERROR / samples**2
    known: np.ndarray = (samples * halves.guides + PRIOR * alike / counts[kinds]) / (samples + PRIOR)
    return 2 * known * samples**ERROR_EXPONENT


def allocate(c: np.ndarray, doublings: np.ndarray, share: float, budget: float) -> np.ndarray:
    """The doublings that leave a `share` of the squared error, or of those that take no more than a budget, in samples
    of packets in a half, the most; never fewer than before."""
    turns = (np.arange(c.size) * GOLDEN_RATIO % 1).reshape(c.shape)  # so that not all that are alike are rounded alike
    ideal = np.log2(np.maximum(c, np.finfo(float).tiny)) / (ERROR_EXPONENT + 1) + turns - 0.5
    limit = np.minimum(doublings + DOUBLINGS_A_ROUND, MOST_DOUBLINGS)
    error_of, price_of = 2.0 ** (-ERROR_EXPONENT * np.arange(MOST_DOUBLINGS + 1)), 2.0 ** np.arange(MOST_DOUBLINGS + 1)
    error, price = (c * error_of[doublings]).sum(), price_of[doublings].sum()

    def at(level: float) -> np.ndarray:
        rounded: np.ndarray = np.clip(np.rint(ideal - level), doublings, limit).astype(np.int64)
        return rounded

    low, high = (ideal - limit).min() - 1, (ideal - doublings).max() + 1  # as much as may be, and nothing
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        new = at(middle)
        if (c * error_of[new]).sum() <= share * error or price_of[new].sum() - price > budget:
            low = middle
        else:
            high = middle
    return at(low) if price_of[at(low)].sum() - price <= budget else at(high)
