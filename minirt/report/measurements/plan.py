"""Plan of a report: how many rays and samples it takes, and how large its pictures are."""

from __future__ import annotations

from math import ceil, log2
from typing import NamedTuple

import numpy as np

from minirt.helpers.system import runs
from minirt.rendering import Renderer
from minirt.report.measurements.run_times import Budget
from minirt.scene import Scene

RAYS = 32  # per shape: a packet in float32


class Plan(NamedTuple):
    """The extent of the measurements."""

    shapes: int  # random shapes of each type in each regime
    samples: int  # samples per pixel of the reference
    most: int  # samples per pixel of the compared pictures, at most
    least_error: float  # asked of automatic sampling
    width: int  # pixels, at most
    seconds: float  # time for the reference, at most
    budget: Budget
    others: bool  # whether other programs are measured, too


FULL = Plan(64, 1024, 64, 0.0005, 16384, 300.0, Budget(0.3, 5.0, tries=3), others=True)
QUICK = Plan(8, 1024, 16, 0.002, 320, 5.0, Budget(0.0, 0.1, tries=3), others=False)


def fitting_size(scene: Scene, size: tuple[int, int], plan: Plan) -> tuple[int, int]:
    """Return the requested size, halved until the reference fits the plan's time.

    Halving, unlike exact scaling, mostly gives the same size when the report is repeated.
    """
    renderer = Renderer()
    renderer.specialise(scene)
    width, height = scaled_size(size, min(1.0, plan.width / size[0]))
    pixels = np.zeros((height, width, 4), np.uint8)
    renderer.render(scene, pixels)
    once = min(runs(lambda: renderer.render(scene, pixels), 2, 0.0)).wall
    halvings = ceil(log2(once * plan.samples / plan.seconds) / 2)
    return scaled_size((width, height), 0.5 ** max(0, halvings))


def scaled_size(size: tuple[int, int], factor: float) -> tuple[int, int]:
    """Scale a size; at least one pixel remains."""
    return max(1, round(size[0] * factor)), max(1, round(size[1] * factor))
