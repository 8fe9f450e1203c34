"""Renders a picture until its estimated error is small enough or its time is used up."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from minirt.kernel.frame import CANCELLED, PACKET_HEIGHT
from minirt.lanes import width
from minirt.rendering.frame_arguments import SamplePass, frame_arguments
from minirt.rendering.running.frame_runner import FrameRunner
from minirt.rendering.sampling.auto import SHIFT_CLASSES, AutoSampler
from minirt.rendering.sampling.outcome import Outcome
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
) -> Outcome | None:
    """Render a scene that has shapes; see `minirt.rendering.sampling.auto`. `pixels` and, where it has rows, `linear`
    are written at the end. None where `cancel` ended it early; then both are as before."""
    start, cancellations = perf_counter(), runner.cancellations
    height, across, _ = pixels.shape
    arrays = packing.pack(scene, across, height)
    frame = frame_arguments(arrays, pixels)
    threads = -(-runner.threads // SHIFT_CLASSES)

    def draw(passes: list[SamplePass]) -> bool:
        counters = runner.new_counters(len(passes))
        if runner.cancellations != cancellations:
            return False
        runner.run([frame.with_pass(samples, counters[i:]) for i, samples in enumerate(passes)], threads)
        return bool(counters.max() < CANCELLED)

    auto = AutoSampler(draw, height, across, width(arrays.camera) // PACKET_HEIGHT)
    outcome = auto.reach(error, seconds - (perf_counter() - start))
    if outcome:
        auto.halves.finish(pixels, linear)
    return outcome and outcome._replace(seconds=perf_counter() - start)
