"""Arguments of the kernel for a picture or a part of it, and sample positions.

Automatic sampling draws by a table: for some numbers of samples those of `--samples N`, a centred lattice, which has
the least error, and references that tell their error. These are the same lattice, shifted at random in each pixel of a
packet and wrapped around (Cranley and Patterson, Randomization of number theoretic methods for multiple integration,
1976): their mean over all shifts is the exact light.
"""

from __future__ import annotations

from functools import cache, lru_cache
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.pixels import PACKET_HEIGHT, SUMS
from minirt.kernel.shading.patterns import SPACING
from minirt.kernel.shadow_rays import CACHED
from minirt.lanes import width
from minirt.rendering.packing import camera
from minirt.rendering.packing.camera import GOLDEN_RATIO, Crop
from minirt.rendering.tone_mapping import NO_LINEAR

# Columns of a plan: the place of a packet among those of the picture, the row of `rays` at which its samples begin,
# their number, and the row at which two sets of as many references begin; 0 for a packet without any.
COLUMN, ROW, FIRST, DRAWN, REFERENCES = range(5)
ALL_PACKETS = np.zeros((0, 5), np.int32)
NO_ERRORS = np.zeros(0)
NOT_FINITE = 1  # in the last row of a thread's memory: the number of rays whose light was not finite


@cache
def sample_positions(samples: int) -> np.ndarray:
    """Positions of the samples in a pixel, (samples, 2): a Fibonacci lattice, centred on the centre of the pixel.

    A lattice that is not centred moves the whole picture: with 4 samples by a fourteenth of a pixel, which was a
    seventh of their error.
    """
    index = np.arange(samples)
    lattice = np.stack([(index + 0.5) / samples, (index * GOLDEN_RATIO + 0.5) % 1.0], axis=1)
    return lattice - lattice.mean(axis=0) + 0.5


class Frame(NamedTuple):
    """Arguments of `minirt.kernel.frame.frame`."""

    next_row: np.ndarray
    pixels: np.ndarray
    linear: np.ndarray
    rays: np.ndarray
    plan: np.ndarray
    errors: np.ndarray
    memory: np.ndarray
    sums: np.ndarray
    scene: Any


def plan_of(packets: np.ndarray, columns: int, drawn: Any) -> np.ndarray:
    """Return the plan (k, 5) that draws k packets, counted row by row, in a picture of so many columns of packets.

    `drawn` (k, 3) or (3,) has the columns `FIRST`, `DRAWN` and `REFERENCES`. A plan without any packet has one that
    takes no samples.
    """
    plan = np.zeros((max(len(packets), 1), 5), np.int32)
    plan[: len(packets), ROW], plan[: len(packets), COLUMN] = np.divmod(packets, columns)
    plan[: len(packets), FIRST:] = drawn
    return plan


@lru_cache(4)
def plan_of_variants(shape: tuple[int, ...], lanes: int, samples: int, variants: int, crop: Crop) -> np.ndarray:
    """Return the plan that draws all packets of a rectangle of a picture, each with one of the variants of its samples.

    The variant of a packet is a random number that depends on its place in the picture alone.
    """
    packet_width = lanes // PACKET_HEIGHT
    rows, columns = -(-shape[0] // PACKET_HEIGHT), -(-shape[1] // packet_width)
    all_columns = -(-crop.width // packet_width)
    random = np.random.Generator(np.random.PCG64(variants))
    left, top = crop.left // packet_width, crop.top // PACKET_HEIGHT
    drawn = np.full((rows, columns, 3), (0, samples, 0), np.int32)
    drawn[..., 0] = samples * random.integers(variants, size=(top + rows, all_columns))[top:, left : left + columns]
    return plan_of(np.arange(rows * columns), columns, drawn.reshape(-1, 3))


def frame_rays(arrays: Any, samples: int) -> np.ndarray:
    """Return the rays of a packet of a packed scene, a row for each sample of each of its variants.

    They are (k, 3 * lanes), or with apertures, a lens or lights with a size, (k, 8 * lanes): see `packet_rays` and
    `with_apertures`. One sample comes from the centre of a lens, and sees the centres of lights.
    """
    lanes = width(arrays.camera)
    places = camera.by_pixel(camera.packet_places(lanes, sample_positions(samples)), samples)
    rays = camera.packet_rays(arrays.camera[camera.STEPS], places)
    if not camera.has_apertures(arrays):
        return rays
    variants = camera.variants_of(samples) if samples > 1 else 1
    discs = np.zeros((1, lanes, 4)) if samples == 1 else camera.aperture_places(samples, variants, lanes, 0)
    return camera.with_apertures(np.tile(rays, (variants, 1)), camera.by_pixel(discs, samples), arrays.lens)


def frame_arguments(
    arrays: Any,
    pixels: np.ndarray,
    samples: int = 1,
    linear: np.ndarray = NO_LINEAR,
    counter: np.ndarray | None = None,
    crop: Crop | None = None,
    rays: np.ndarray | None = None,
    memory: tuple[np.ndarray, np.ndarray] | None = None,
) -> Frame:
    """Return the arguments of the kernel that draws all packets of a packed scene: of a picture, or of the rectangle of
    a larger one at `crop`.

    The kernel writes `pixels`, (h, w, 4) uint8, and `linear`, (h, w, 3), which has no rows where nobody wants light.
    `counter` (1,) counts the rows that threads have taken. `rays` are those of `frame_rays`, and `memory` is that of
    `thread_memory`; what of these is None is made anew. `crop` chooses the samples of apertures: the camera of `arrays`
    is that of the crop already.
    """
    plan = ALL_PACKETS
    if rays is None:
        rays = frame_rays(arrays, samples)
    if samples > 1 and camera.has_apertures(arrays):
        whole = Crop(pixels.shape[1], pixels.shape[0])
        variants = len(rays) // samples
        plan = plan_of_variants(pixels.shape, width(rays), samples, variants, crop or whole)
    return Frame(
        np.zeros(1, np.int64) if counter is None else counter,
        pixels.view(np.uint32)[..., 0],  # numbers 0xAARRGGBB
        linear,
        rays,
        plan,
        NO_ERRORS,
        *(memory or thread_memory(arrays)),
        arrays,
    )


def thread_memory(arrays: Any) -> tuple[np.ndarray, np.ndarray]:
    """Allocate what a thread remembers from one packet to the next, still empty (see `minirt.kernel.trace`), and the
    buffer in which it sums the light of a tile."""
    kept = 2 * width(arrays.camera) if arrays.soft is not None else 0
    memory = np.zeros((len(arrays.lights) + 1, CACHED + kept), arrays.lights.dtype)
    memory[-1, SPACING] = 1.0
    return memory, np.empty(SUMS, arrays.camera.dtype)


# Numbers of samples that a packet may have, four for each doubling; a level is an index of them.
COUNTS = np.array([1, 2, 3, *(size * 2**k for k in range(10) for size in (4, 5, 6, 7)), 4096], np.int32)
VARIANTS = 16  # pairs of references for few samples, so that an edge along a row of pixels is met at many distances
REFERENCE_ROWS = 256  # of the table, for one number of samples, that more than one pair may take


class SampleTable:
    """Places of samples in a packet (rows, rays, 2) for packets of some levels, and where each level begins.

    `with_places` gives each sample places in the discs of lens and lights, too: (rows, rays, 6). Drawn samples then
    have variants, too: see `minirt.rendering.packing.camera`. There are no more variants than packets.
    """

    def __init__(
        self, levels: np.ndarray, pixels: int, with_places: bool = False, with_references: bool = True
    ) -> None:
        """Place samples for n packets of so many pixels. `levels` (n,) has for each an index of COUNTS.

        `with_references` adds samples for an estimate of the error.
        """
        self.with_references = with_references
        # For each level: the rows at which samples and references begin, and how many variants of both there are.
        self.first, self.reference = np.zeros((2, len(COUNTS)), np.int32)
        self.drawn_variants, self.variants = np.ones((2, len(COUNTS)), np.int32)
        parts, rows = [], 0
        for level, packets in enumerate(np.bincount(levels).tolist()):
            if not packets:
                continue
            count = int(COUNTS[level])
            most = 2 ** (packets - 1).bit_length()  # variants: as many as packets, rounded up to a power of two
            pairs = min(max(REFERENCE_ROWS // (2 * count), 1), VARIANTS, most)
            drawn = min(camera.variants_of(count), most) if with_places else 1
            self.variants[level], self.drawn_variants[level] = pairs, drawn
            pairs = pairs if with_references else 0
            self.first[level], self.reference[level] = rows, rows + count * drawn
            parts.append(positions_of(count, drawn, pairs, pixels, with_places))
            rows += count * (drawn + 2 * pairs)
        self.positions = np.concatenate(parts)

    def plan(self, levels: np.ndarray) -> np.ndarray:
        """Rows of the plan of `minirt.kernel.frame.frame` for packets of some levels."""
        counts, references = COUNTS[levels], np.zeros(len(levels), np.int32)
        chosen = (random_numbers(len(levels)) * self.drawn_variants[levels]).astype(np.int32)
        if self.with_references:
            pair = np.arange(len(levels)) % self.variants[levels]
            references = self.reference[levels] + 2 * counts * pair
        return np.stack([self.first[levels] + counts * chosen, counts, references], axis=1)


@lru_cache(32)
def positions_of(count: int, drawn: int, pairs: int, pixels: int, with_places: bool) -> np.ndarray:
    """The places of variants of drawn samples and of their references in a packet, or also those in lens and lights."""
    # Shifts of both references of each pair, independent and the same at each call.
    shifts = random_numbers(2 * pairs * pixels * 2).reshape(2 * pairs, pixels, 2)
    lattice = sample_positions(count)
    references = lattice[:, None] + shifts[:, None]
    references -= references >= 1.0
    positions = np.tile(sample_positions(count)[:, None], (drawn, pixels, 1)), references.reshape(-1, pixels, 2)
    parts = [camera.packet_places(pixels, np.concatenate(positions))]
    if with_places:
        discs = camera.aperture_places(count, drawn, pixels, 1), camera.aperture_places(count, 2 * pairs, pixels, 2)
        parts.append(np.concatenate(discs))
    return camera.by_pixel(np.concatenate(parts, axis=-1), count)


@cache
def random_numbers(count: int) -> np.ndarray:
    """Random numbers in [0, 1), the same at each call: from a stream that numpy keeps stable."""
    return (np.random.PCG64(2).random_raw(count) >> np.uint64(11)) * 2.0**-53
