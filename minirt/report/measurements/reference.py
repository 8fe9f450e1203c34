"""Reference picture: many samples per pixel, at other positions than those of the compared pictures."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from minirt.lanes import width as lanes_of
from minirt.rendering import Renderer
from minirt.rendering.frame import frame_arguments, sample_positions
from minirt.rendering.packing.camera import aperture_places, has_apertures, packet_rays, with_apertures
from minirt.report.measurements.metrics import Picture, clamped, rmse
from minirt.scene import Scene

PASS = 32  # samples per pixel of one call of the kernel


class Reference(NamedTuple):
    """A picture in float64, its samples per pixel and its estimated error."""

    picture: Picture
    samples: int
    error: float  # estimated RMSE of the reference itself


def reference(
    scene: Scene, width: int, height: int, samples: int, seed: int, step: Callable[[], object] = lambda: None
) -> Reference:
    """Render the reference picture as the mean of two halves; `step` is called `passes(samples)` times.

    Each half has the usual lattice of samples, shifted by a random phase. The errors of the halves are independent, so
    the RMSE of their mean is half of the RMSE between them.
    """
    renderer, random = Renderer(), np.random.default_rng(seed)
    one, other = (
        clamped(
            half_reference(
                renderer,
                scene,
                width,
                height,
                (sample_positions(samples // 2) + random.random(2)) % 1.0,
                step,
                2 * seed + half,
            )
        )
        for half in range(2)
    )
    return Reference((one + other) / 2, samples, rmse(one, other) / 2)


def passes(samples: int) -> int:
    """Return the number of steps that rendering a reference takes."""
    return 2 * -(-(samples // 2) // PASS)


def half_reference(
    renderer: Renderer,
    scene: Scene,
    width: int,
    height: int,
    places: np.ndarray,
    step: Callable[[], object],
    seed: int = 0,
) -> Picture:
    """Render the mean radiance over sample positions `places`, (n, 2) in units of a pixel.

    `seed` chooses those in lens and lights.
    """
    total = np.zeros((height, width, 3))
    if not scene.shapes:
        return total
    pixels, linear = np.zeros((height, width, 4), np.uint8), np.zeros((height, width, 3))
    for start in range(0, len(places), PASS):
        some = places[start : start + PASS]
        traced = renderer.packing.pack(scene, width, height)
        rays = packet_rays(traced.camera, some)
        if has_apertures(traced):
            discs = aperture_places(len(places), 1, lanes_of(traced.camera), seed)[start : start + PASS]
            rays = with_apertures(rays, discs, traced.lens)
        arguments = frame_arguments(traced, pixels, linear=linear)._replace(rays=rays)
        renderer.runner.next_row = arguments.next_row  # so that it can be cancelled
        renderer.runner.run([arguments], renderer.threads)
        total += linear * len(some)
        step()
    return total / len(places)
