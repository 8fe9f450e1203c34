"""Table of sample positions: for some numbers of samples, those that are drawn, and references that tell their error.

The drawn samples are those of `--samples N`, a centred lattice, which has the least error. References are a lattice of
`REFERENCE_SAMPLES` times as many, shifted at random in each pixel of a packet and wrapped around (Cranley and
Patterson, Randomization of number theoretic methods for multiple integration, 1976): their mean over all shifts is the
exact light.
"""

from __future__ import annotations

from functools import cache, lru_cache

import numpy as np

from minirt.kernel.frame import REFERENCE_SAMPLES
from minirt.rendering.frame import sample_positions
from minirt.rendering.packing.camera import aperture_places, variants_of

# Numbers of samples that a packet may have, two for each doubling; a level is an index of them.
COUNTS = np.array([1, 2, *(size * 2**k for k in range(1, 16) for size in (1.5, 2))], np.int32)
VARIANTS = 16  # pairs of references for few samples, so that an edge along a row of pixels is met at many distances
REFERENCE_ROWS = 256  # of the table, for one number of samples, that more than one pair may take


class SampleTable:
    """Sample positions (rows, pixels of a packet, 2) for some levels, and where each begins.

    `with_places` gives each sample places in the discs of lens and lights, too: (rows, pixels, 6). Drawn samples then
    have variants, too: see `minirt.rendering.packing.camera`.
    """

    def __init__(self, levels: np.ndarray, pixels: int, with_places: bool = False) -> None:
        self.first = np.zeros(len(COUNTS), np.int32)  # row of the drawn samples of a level
        self.reference = np.zeros(len(COUNTS), np.int32)  # row of its first pair of references
        self.variants = np.ones(len(COUNTS), np.int32)
        self.drawn_variants = np.ones(len(COUNTS), np.int32)
        parts, rows = [], 0
        for level in levels.tolist():
            count = int(COUNTS[level])
            self.variants[level] = min(max(REFERENCE_ROWS // (2 * REFERENCE_SAMPLES * count), 1), VARIANTS)
            self.drawn_variants[level] = variants_of(count) if with_places else 1
            drawn, pairs = int(self.drawn_variants[level]), int(self.variants[level])
            self.first[level], self.reference[level] = rows, rows + count * drawn
            parts.append(positions_of(count, drawn, pairs, pixels, with_places))
            rows += count * (drawn + 2 * REFERENCE_SAMPLES * pairs)
        self.positions = np.concatenate(parts)

    def plan(self, levels: np.ndarray, probed: np.ndarray) -> np.ndarray:
        """Rows of the plan of `minirt.kernel.frame.frame` for packets of some levels; those `probed` get references."""
        plan = np.zeros((len(levels), 3), np.int32)
        plan[:, 0] = self.first[levels]
        plan[:, 1] = COUNTS[levels]
        if self.drawn_variants.max() > 1:
            chosen = (random_numbers(len(levels)) * self.drawn_variants[levels]).astype(np.int32)
            plan[:, 0] += COUNTS[levels] * chosen
        chosen = levels[probed]
        pairs = 2 * REFERENCE_SAMPLES * COUNTS[chosen] * (np.arange(len(chosen)) % self.variants[chosen])
        plan[probed, 2] = self.reference[chosen] + pairs
        return plan


@lru_cache(32)
def positions_of(count: int, drawn: int, pairs: int, pixels: int, with_places: bool) -> np.ndarray:
    """The positions of variants of drawn samples and of their references, or also the places in lens and lights."""
    lattice, shifts = sample_positions(REFERENCE_SAMPLES * count), random_shifts(pairs, pixels)
    references = lattice[:, None] + shifts[:, None]
    references -= references >= 1.0
    positions = np.tile(sample_positions(count)[:, None], (drawn, pixels, 1)), references.reshape(-1, pixels, 2)
    if not with_places:
        return np.concatenate(positions)
    places = aperture_places(count, drawn, pixels, 1), aperture_places(REFERENCE_SAMPLES * count, 2 * pairs, pixels, 2)
    return np.concatenate([np.concatenate(positions), np.concatenate(places)], axis=-1)


@cache
def random_shifts(variants: int, pixels: int) -> np.ndarray:
    """Independent shifts of both references of each pair, (2 * variants, pixels, 2), the same at each call."""
    shifts: np.ndarray = random_numbers(2 * variants * pixels * 2).reshape(2 * variants, pixels, 2)
    return shifts


@cache
def random_numbers(count: int) -> np.ndarray:
    """Random numbers in [0, 1), the same at each call: from a stream that numpy keeps stable."""
    numbers: np.ndarray = (np.random.PCG64(2).random_raw(count) >> np.uint64(11)) * 2.0**-53
    return numbers


def table_rays(camera: np.ndarray, positions: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """The rays of `minirt.rendering.packing.camera.packet_rays`, for many samples: a tenth of its time.

    `offsets` (2, pixels) are `packet_pixels`.
    """
    across, down = camera[6:9, None], camera[9:12, None]
    rays = (positions[:, None, :, 0] + offsets[0]) * across
    rays += (positions[:, None, :, 1] + offsets[1]) * down
    converted: np.ndarray = rays.reshape(len(positions), -1).astype(camera.dtype, copy=False)
    return converted
