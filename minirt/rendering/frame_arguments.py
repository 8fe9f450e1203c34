"""Arguments of the kernel for a picture or a part of it."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.frame import SUMS
from minirt.rendering.packing.camera import packet_rays

NO_LINEAR = np.zeros((0, 0, 3))
ALL_PACKETS = np.zeros((0, 5), np.int32)
NO_ERRORS = np.zeros(0)
GOLDEN_RATIO = (5**0.5 - 1) / 2  # its conjugate, 0.618...


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


def frame_arguments(
    arrays: Any, pixels: np.ndarray, samples: int = 1, linear: np.ndarray = NO_LINEAR, counter: np.ndarray | None = None
) -> Frame:
    """Return the arguments for a picture of all packets of a packed scene."""
    return Frame(
        next_row=np.zeros(1, np.int64) if counter is None else counter,
        pixels=as_uint32(pixels),
        linear=linear,
        rays=packet_rays(arrays.camera, sample_positions(samples)),
        plan=ALL_PACKETS,
        errors=NO_ERRORS,
        memory=thread_memory(arrays),
        sums=sum_buffer(arrays),
        scene=arrays,
    )


def as_uint32(pixels: np.ndarray) -> np.ndarray:
    """View pixels (h, w, 4) as numbers 0xAARRGGBB (h, w), in the same memory."""
    numbers: np.ndarray = pixels.view(np.uint32)[..., 0]
    return numbers


def sum_buffer(arrays: Any) -> np.ndarray:
    """Allocate the buffer in which a thread sums the light of a tile."""
    return np.empty(SUMS, arrays.camera.dtype)


def thread_memory(arrays: Any) -> np.ndarray:
    """Allocate the memory of a thread from one packet to the next, still empty: see `minirt.kernel.trace`."""
    return np.zeros((len(arrays.lights) + 1, 4), arrays.lights.dtype)
