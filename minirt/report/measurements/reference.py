"""The picture that others are compared with: many samples, in other places of the pixels than theirs."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from minirt.rendering import Renderer
from minirt.rendering.frame_arguments import frame_arguments, sample_positions
from minirt.rendering.packing.camera import packet_rays
from minirt.report.measurements.metrics import Picture, rmse, shown
from minirt.scene import Scene

PASS = 32  # samples that are taken in one go


class Reference(NamedTuple):
    """A picture in float64 and what is known about it."""

    picture: Picture
    samples: int
    error: float  # of its own: root mean square


def reference(
    scene: Scene, width: int, height: int, samples: int, seed: int, step: Callable[[], object] = lambda: None
) -> Reference:
    """The reference picture, of two halves; `step` is called `passes(samples)` times on the way.

    Each half has the usual lattice of samples, shifted by a random phase. Their errors have nothing to do with each
    other, so that of the mean of both is half of the difference between them.
    """
    renderer, random = Renderer(), np.random.default_rng(seed)
    one, other = (
        shown(half(renderer, scene, width, height, (sample_positions(samples // 2) + random.random(2)) % 1.0, step))
        for _ in range(2)
    )
    return Reference((one + other) / 2, samples, rmse(one, other) / 2)


def passes(samples: int) -> int:
    """The number of steps of a reference."""
    return 2 * -(-(samples // 2) // PASS)


def half(
    renderer: Renderer, scene: Scene, width: int, height: int, places: np.ndarray, step: Callable[[], object]
) -> Picture:
    """The mean of the light at some places (n, 2) of each pixel."""
    total = np.zeros((height, width, 3))
    if not scene.shapes:
        return total
    pixels, linear = np.zeros((height, width, 4), np.uint8), np.zeros((height, width, 3))
    for start in range(0, len(places), PASS):
        some = places[start : start + PASS]
        traced = renderer.packing.pack(scene, width, height)
        given = frame_arguments(traced, pixels, linear=linear)._replace(rays=packet_rays(traced.camera, some))
        renderer.runner.next_row = given.next_row  # so that it can be cancelled
        renderer.runner.run([given], renderer.threads)
        total += linear * len(some)
        step()
    return total / len(places)
