"""Renders a picture, or its edges alone, with a given number of samples a pixel."""

from __future__ import annotations

from collections.abc import Callable
from itertools import takewhile

import numpy as np

from minirt.kernel.frame import CANCELLED, PACKET_HEIGHT
from minirt.lanes import width
from minirt.rendering.frame_arguments import frame_arguments
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
) -> bool:
    """Render a scene that has shapes into `pixels` and `linear`; with `edges_only` only the packets in which
    neighbouring pixels differ. False where it was cancelled or `is_wanted` said no."""
    counter = runner.new_counters(1)
    if not is_wanted():
        return False
    arrays = packing.pack(scene, pixels.shape[1], pixels.shape[0])
    frame = frame_arguments(arrays, pixels, samples, linear, counter)
    if edges_only:
        strips = edge_packets(pixels, width(arrays.camera) // PACKET_HEIGHT)
        found = list(takewhile(lambda _: counter[0] < CANCELLED, strips))
        if found:
            frame = frame.with_samples_where(np.concatenate(found))
    runner.run([frame], runner.threads)
    return bool(counter[0] < CANCELLED)
