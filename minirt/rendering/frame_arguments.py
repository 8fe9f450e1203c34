"""What the kernel is called with for a picture or a part of it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from minirt.kernel.frame import TILE
from minirt.rendering.packing.camera import packet_rays

if TYPE_CHECKING:
    from minirt.rendering.sampling.auto import Task

NO_LINEAR = np.zeros((0, 0, 3))
ALL_PACKETS = np.zeros((0, 0), np.uint8)
GOLDEN = (5**0.5 - 1) / 2


@cache
def sample_places(samples: int) -> np.ndarray:
    """Where in a pixel its samples lie, (samples, 2): a Fibonacci lattice whose middle is the middle of the pixel.

    With its middle elsewhere the whole picture would be moved: of 4 samples by a fourteenth of a pixel, which was a
    seventh of their error.
    """
    each = np.arange(samples)
    lattice = np.stack([(each + 0.5) / samples, (each * GOLDEN + 0.5) % 1.0], axis=1)
    centred: np.ndarray = lattice - lattice.mean(axis=0) + 0.5
    return centred


class Frame(NamedTuple):
    """What `minirt.kernel.frame.frame` is called with."""

    next_row: np.ndarray
    pixels: np.ndarray
    linear: np.ndarray
    rays: np.ndarray
    wanted: np.ndarray
    memory: np.ndarray
    sums: np.ndarray
    scene: Any

    def of(self, task: Task, counter: np.ndarray) -> Frame:
        """The frame of a task of `minirt.rendering.sampling.auto`."""
        return self._replace(
            next_row=counter,
            pixels=as_words(task.pixels),
            linear=task.light,
            rays=packet_rays(self.scene.camera, task.places),
            wanted=task.packets,
        )


def frame_arguments(
    traced: Any, pixels: np.ndarray, samples: int = 1, linear: np.ndarray = NO_LINEAR, counter: np.ndarray | None = None
) -> Frame:
    """A frame of all packets."""
    return Frame(
        next_row=np.zeros(1, np.int64) if counter is None else counter,
        pixels=as_words(pixels),
        linear=linear,
        rays=packet_rays(traced.camera, sample_places(samples)),
        wanted=ALL_PACKETS,
        memory=memory_for(traced),
        sums=room_for_sums(traced),
        scene=traced,
    )


def as_words(pixels: np.ndarray) -> np.ndarray:
    """Pixels (h, w, 4) as numbers 0xAARRGGBB (h, w), in the same memory."""
    words: np.ndarray = pixels.view(np.uint32)[..., 0]
    return words


def room_for_sums(traced: Any) -> np.ndarray:
    """Room for the light of a tile."""
    return np.empty(3 * TILE * TILE, traced.camera.dtype)


def memory_for(traced: Any) -> np.ndarray:
    """What a thread remembers from one packet to the next, see `minirt.kernel.trace`: nothing yet."""
    return np.zeros((len(traced.lights) + 1, 4), traced.lights.dtype)
