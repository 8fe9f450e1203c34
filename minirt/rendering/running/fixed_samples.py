"""Renders a picture, or its edges alone, with a given number of samples a pixel."""

from __future__ import annotations

from collections.abc import Callable
from itertools import takewhile

import numpy as np

from minirt.kernel.frame import CANCELLED
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.lanes import width
from minirt.rendering.crop import Crop
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.packing.aperture_rays import has_apertures
from minirt.rendering.running.frame_runner import FrameRunner
from minirt.rendering.sampling.adaptive import edge_packets
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene


def render(
    runner: FrameRunner,
    packing: Packing,
    scene: Scene,
    pixels: np.ndarray,
    linear: np.ndarray,
    samples: int,
    is_wanted: Callable[[], bool],
    edges_only: bool,
    crop: Crop | None = None,
) -> bool:
    """Render a scene that has shapes, or a crop, into `pixels` and `linear`; with `edges_only` only packets in which
    neighbouring pixels differ, unless a lens or a light with a size blurs others, too. False where it was cancelled or
    `is_wanted` said no."""
    counter = runner.new_counters(1)
    if not is_wanted():
        return False
    arrays = packing.pack(scene, pixels.shape[1], pixels.shape[0], crop)
    frame = frame_arguments(arrays, pixels, samples, linear, counter, crop)
    if edges_only and not has_apertures(arrays):
        strips = edge_packets(pixels, width(arrays.camera) // PACKET_HEIGHT)
        found = list(takewhile(lambda _: counter[0] < CANCELLED, strips))
        if found:
            frame = frame.with_samples_where(np.concatenate(found))
    runner.run([frame], runner.threads)
    return bool(counter[0] < CANCELLED)
