"""Sobol' sequence in two dimensions, with digital shifts: sample positions that can be continued.

Each doubling of the number of points fills the gaps between those before. Of 2^k points, from a multiple of 2^k on,
each of 2^k equal elementary boxes of the pixel has one, whichever way it is cut (Sobol', On the distribution of points
in a cube, 1967). A digital shift keeps that, and makes each point uniform in the pixel, so that means over shifted
points have no bias and means over independently shifted points have independent errors (L'Ecuyer and Lemieux, Recent
advances in randomized quasi-Monte Carlo methods, 2002).
"""

from __future__ import annotations

import numpy as np

BITS = 32
UNIT = 2.0**-BITS


def sobol(first: int, last: int) -> np.ndarray:
    """The points from number `first` up to, but without, `last`, as (n, 2) integer multiples of 2^-32, uint32."""
    index = np.arange(first, last, dtype=np.uint32)
    points = np.zeros((len(index), 2), np.uint32)
    column = np.uint32(1 << BITS - 1)
    for bit in range(int(last - 1).bit_length()):
        is_set = (index >> np.uint32(bit) & np.uint32(1)).astype(bool)
        points[is_set, 0] ^= np.uint32(1 << BITS - 1 - bit)
        points[is_set, 1] ^= column
        column ^= column >> np.uint32(1)
    return points


def digital_shifts(*shape: int) -> np.ndarray:
    """Independent random shifts, (*shape, 2) uint32, the same at each call."""
    bits: np.ndarray = np.random.PCG64(2).random_raw((*shape, 2)) >> np.uint64(32)  # a stream that numpy keeps stable
    return bits.astype(np.uint32)


def shifted(points: np.ndarray, shifts: np.ndarray) -> np.ndarray:
    """Shift points (n, 2) in each of m ways (m, 2): positions (n, m, 2) in [0, 1)."""
    positions: np.ndarray = (points[:, None] ^ shifts) * UNIT
    return positions
