"""Allocates samples to packets so that a given error, or the least for a given cost, is reached.

Where n samples lie evenly in a pixel with an edge, the squared error is about c / n^1.5 (Mitchell, Consequences of
stratified sampling in graphics, 1996). To reach a sum of such errors at the least cost, the sum of n, each packet gets
a number of samples in proportion to c^0.4.

c is estimated from the guides of a packet (see `minirt.rendering.sampling.replicates`); with few samples they know
little. So the estimate is mixed with the judges of all packets with as many samples and as much contrast: c of a packet
with an edge is not 0 because its halves happen to agree. And since all of them may have missed something, one sample
more than they have counts as if it differed.
"""

from __future__ import annotations

import numpy as np

from minirt.rendering.frame_arguments import GOLDEN_RATIO
from minirt.rendering.sampling.replicates import Replicates

ERROR_EXPONENT = 1.5  # squared error falls as this power of the number of samples
CONTRASTS = (1, 4, 16, 64)  # levels of 255; packets are of the same class if they exceed as many of them
PRIOR = 4.0  # samples that the mean of the class of a packet counts as
# Sum of squares of a pixel that differs by a half in one of three colours, / 4 for the mean of two halves.
UNSEEN_ERROR = 1 / 16
MOST_DOUBLINGS = 15  # 65536 samples in both halves
DOUBLINGS_A_ROUND = 3
BISECTIONS = 14  # of the interval of levels


def coefficients(halves: Replicates, doublings: np.ndarray, contrast: np.ndarray) -> np.ndarray:
    """Estimate c of every packet, which has 2^doublings samples in each half and exceeds so many of `CONTRASTS`."""
    samples = 2.0**doublings
    classes = doublings * (len(CONTRASTS) + 1) + contrast
    counts = np.bincount(classes.ravel())
    judges = np.bincount(classes.ravel(), halves.judges.ravel())
    class_error = judges[classes] + UNSEEN_ERROR / samples**2
    error: np.ndarray = (samples * halves.guides + PRIOR * class_error / counts[classes]) / (samples + PRIOR)
    return 2 * error * samples**ERROR_EXPONENT


def allocate(c: np.ndarray, doublings: np.ndarray, share: float, budget: float) -> np.ndarray:
    """The new doublings, never fewer than before, that leave a `share` of the squared error; or, if those cost more
    than the budget, in samples of packets in a half, the most that the budget pays for."""
    # Offsets by which packets with equal c are not all rounded in the same direction.
    dither = (np.arange(c.size) * GOLDEN_RATIO % 1).reshape(c.shape)
    ideal = np.log2(np.maximum(c, np.finfo(float).tiny)) / (ERROR_EXPONENT + 1) + dither - 0.5
    limit = np.minimum(doublings + DOUBLINGS_A_ROUND, MOST_DOUBLINGS)
    error_of, cost_of = 2.0 ** (-ERROR_EXPONENT * np.arange(MOST_DOUBLINGS + 1)), 2.0 ** np.arange(MOST_DOUBLINGS + 1)
    error, cost = (c * error_of[doublings]).sum(), cost_of[doublings].sum()

    def at(level: float) -> np.ndarray:
        rounded: np.ndarray = np.clip(np.rint(ideal - level), doublings, limit).astype(np.int64)
        return rounded

    low, high = (ideal - limit).min() - 1, (ideal - doublings).max() + 1  # all that is allowed, and nothing
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        new = at(middle)
        if (c * error_of[new]).sum() <= share * error or cost_of[new].sum() - cost > budget:
            low = middle
        else:
            high = middle
    return at(low) if cost_of[at(low)].sum() - cost <= budget else at(high)
