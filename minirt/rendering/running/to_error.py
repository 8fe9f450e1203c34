"""Renders a picture until its estimated error is small enough or its time is used up."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from minirt.kernel.frame import CANCELLED
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.lanes import width
from minirt.rendering.crop import Crop
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.packing.aperture_rays import has_apertures, with_apertures
from minirt.rendering.packing.camera import packet_pixels
from minirt.rendering.running.frame_runner import FrameRunner
from minirt.rendering.sampling.auto import AutoSampler, Sweep
from minirt.rendering.sampling.contrast import contrast_classes
from minirt.rendering.sampling.outcome import ROUNDING_DECIDES, Outcome
from minirt.rendering.sampling.packets import Packets
from minirt.rendering.sampling.sample_table import table_rays
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene


def reach(
    runner: FrameRunner,
    packing: Packing,
    scene: Scene,
    pixels: np.ndarray,
    linear: np.ndarray,
    error: float,
    seconds: float,
    least: float | None = None,
    crop: Crop | None = None,
) -> Outcome | None:
    """Render a scene that has shapes, or a crop of its picture, as `minirt.rendering.sampling.auto` tells.

    `pixels` and, where it has rows, `linear` are incomplete where `cancel` ended it early, which returns None. `least`
    is the error below which more samples are useless: where it is not given, that at which rounding to 8 bits decides,
    and 0 with `linear`.
    """
    start, cancellations = perf_counter(), runner.cancellations
    height, across, _ = pixels.shape
    arrays = packing.pack(scene, across, height, crop)
    frame = frame_arguments(arrays, pixels, linear=linear)
    with_places = has_apertures(arrays)
    packet_width = width(arrays.camera) // PACKET_HEIGHT
    offsets = packet_pixels(width(arrays.camera))

    def draw(sweep: Sweep) -> bool:
        counters = runner.new_counters(1 + sweep.is_first)
        if runner.cancellations != cancellations:
            return False
        rays = table_rays(arrays.camera, sweep.positions, offsets)
        if with_places:
            rays = with_apertures(rays, sweep.positions[..., 2:], arrays.lens)
        planned = frame._replace(next_row=counters[-1:], rays=rays, plan=sweep.plan, errors=sweep.errors)
        whole = [frame._replace(next_row=counters[:1], rays=rays[:1])] if sweep.is_first else []
        runner.run([*whole, planned], runner.threads)
        return bool((counters < CANCELLED).all())

    def classify() -> tuple[np.ndarray, np.ndarray]:
        return contrast_classes(pixels, packet_width, lambda jobs: runner.pool.run(jobs, runner.cancel), runner.threads)

    if least is None:  # rounding to 8 bits, where nobody wants the light itself, makes less error useless
        least = 0.0 if len(linear) else ROUNDING_DECIDES
    packets = Packets(height, across, packet_width)
    auto = AutoSampler(draw, classify, packets, 3 * height * across, len(offsets[0]), with_places)
    outcome = auto.reach(max(error, least), seconds - (perf_counter() - start))
    return outcome and outcome._replace(
        seconds=perf_counter() - start, goal=error, rounded=error < outcome.error <= least
    )
