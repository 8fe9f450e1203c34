"""A picture in memory that several workers render."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from minirt.cluster.bands import whole
from minirt.cluster.still import Still
from minirt.cluster.task import Region, Settings
from minirt.cluster.workers import WorkerPool, Workers
from minirt.image import Image, LinearImage
from minirt.rendering.outcome import Outcome
from minirt.scene import Scene


def render_in_bands(
    scene: Scene,
    settings: Settings,
    executor: Workers | None,
    threads: int | None = None,
    linear: bool = False,
    region: Region | None = None,
    on_progress: Callable[[int, int], object] = lambda done, bands: None,
) -> Image:
    """Return the picture that `minirt.render` returns, made by the workers of an executor; see `render_to`."""
    still = Still(scene, settings, region, "light" if linear else "levels")
    _, top, width, height = still.region
    levels = np.empty((height, width, 3), np.uint8)
    light = np.empty((height, width, 3)) if linear else None
    parts: list[tuple[int, Outcome | None]] = []
    for number, made in still.made(WorkerPool(executor, threads)):
        _, first, _, rows = still.bands[number]
        levels[first - top : first - top + rows] = made.arrays[0]
        if light is not None:
            light[first - top : first - top + rows] = made.arrays[1]
        parts.append((rows, made.reached))
        on_progress(len(parts), len(still.bands))
    reached, tone = whole(parts), scene.camera.tone
    return Image(levels, None, reached, tone) if light is None else LinearImage(levels, light, reached, tone)
