"""Arguments of the kernel for a picture or a part of it."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.pixels import PACKET_HEIGHT, SUMS
from minirt.lanes import width
from minirt.rendering.packing.camera import (
    GOLDEN_RATIO,
    Crop,
    aperture_places,
    has_apertures,
    packet_rays,
    variants_of,
    with_apertures,
)
from minirt.rendering.tone_mapping import NO_LINEAR

ALL_PACKETS = np.zeros((0, 5), np.int32)
NO_ERRORS = np.zeros(0)


@cache
def sample_positions(samples: int) -> np.ndarray:
    """Positions of the samples in a pixel, (samples, 2): a Fibonacci lattice, centred on the centre of the pixel.

    A lattice that is not centred moves the whole picture: with 4 samples by a fourteenth of a pixel, which was a
    seventh of their error.
    """
    index = np.arange(samples)
    lattice = np.stack([(index + 0.5) / samples, (index * GOLDEN_RATIO + 0.5) % 1.0], axis=1)
    centred: np.ndarray = lattice - lattice.mean(axis=0) + 0.5
    return centred


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

    def with_samples_where(self, packets: np.ndarray) -> Frame:
        """Return the arguments for the same samples, but only in some packets: (rows, columns), not 0 where wanted."""
        places = np.flatnonzero(packets)
        drawn = np.zeros((len(places), 3), np.int32)
        drawn[:, 1] = len(self.rays)
        return self._replace(plan=plan_of(places, packets.shape[1], drawn))


def plan_of(packets: np.ndarray, columns: int, drawn: np.ndarray) -> np.ndarray:
    """Return the plan that draws packets, counted row by row, in a picture of so many columns of packets. `drawn`
    (k, 3) has their other numbers. A plan without any packet has one that takes no samples."""
    plan = np.zeros((max(len(packets), 1), 5), np.int32)
    plan[: len(packets), 1], plan[: len(packets), 0] = np.divmod(packets, columns)
    plan[: len(packets), 2:] = drawn
    return plan


@lru_cache(4)
def plan_of_variants(shape: tuple[int, ...], lanes: int, samples: int, variants: int, crop: Crop) -> np.ndarray:
    """Return the plan that draws all packets of a rectangle of a picture, each with one of the variants of its samples.

    The variant of a packet is a random number that depends on its place in the picture alone.
    """
    packet_width = lanes // PACKET_HEIGHT
    rows, columns, all_columns = (
        -(-size // step)
        for size, step in ((shape[0], PACKET_HEIGHT), (shape[1], packet_width), (crop.width, packet_width))
    )
    random = np.random.Generator(np.random.PCG64(variants))
    left, top = crop.left // packet_width, crop.top // PACKET_HEIGHT
    drawn = np.full((rows, columns, 3), (0, samples, 0), np.int32)
    drawn[..., 0] = samples * random.integers(variants, size=(top + rows, all_columns))[top:, left : left + columns]
    return plan_of(np.arange(rows * columns), columns, drawn.reshape(-1, 3))


def frame_arguments(
    arrays: Any,
    pixels: np.ndarray,
    samples: int = 1,
    linear: np.ndarray = NO_LINEAR,
    counter: np.ndarray | None = None,
    crop: Crop | None = None,
) -> Frame:
    """Return the arguments for all packets of a packed scene: of a picture, or of a rectangle of a larger one.

    One sample is that from the centre of a lens, and of the centres of lights.
    """
    rays, plan = packet_rays(arrays.camera, sample_positions(samples)), ALL_PACKETS
    if has_apertures(arrays):
        lanes, variants = width(rays), variants_of(samples) if samples > 1 else 1
        places = np.zeros((1, lanes, 4)) if samples == 1 else aperture_places(samples, variants, lanes, 0)
        rays = with_apertures(np.tile(rays, (variants, 1)), places, arrays.lens)
        if samples > 1:
            whole = Crop(pixels.shape[1], pixels.shape[0])
            plan = plan_of_variants(pixels.shape, lanes, samples, variants, crop or whole)
    return Frame(
        next_row=np.zeros(1, np.int64) if counter is None else counter,
        pixels=pixels.view(np.uint32)[..., 0],  # numbers 0xAARRGGBB
        linear=linear,
        rays=rays,
        plan=plan,
        errors=NO_ERRORS,
        memory=thread_memory(arrays),
        sums=sum_buffer(arrays),
        scene=arrays,
    )


def sum_buffer(arrays: Any) -> np.ndarray:
    """Allocate the buffer in which a thread sums the light of a tile."""
    return np.empty(SUMS, arrays.camera.dtype)


def thread_memory(arrays: Any) -> np.ndarray:
    """Allocate the memory of a thread from one packet to the next, still empty: see `minirt.kernel.trace`."""
    kept = 2 * width(arrays.camera) if arrays.soft is not None else 0
    return np.zeros((len(arrays.lights) + 1, 4 + kept), arrays.lights.dtype)
