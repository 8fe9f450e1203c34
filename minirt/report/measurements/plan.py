"""How thorough a report is, and how large its pictures are."""

from __future__ import annotations

from math import ceil, log2
from typing import NamedTuple

import numpy as np

from minirt.rendering import Renderer
from minirt.report.measurements.picture_errors import Budget
from minirt.scene import Scene
from minirt.timing import runs

RAYS = 32  # for each shape: a packet in float32


class Plan(NamedTuple):
    """What is measured."""

    shapes: int  # random ones of each kind, in each regime
    samples: int  # of a pixel of the reference
    most: int  # samples of the pictures that are compared with it
    width: int  # pixels, at most
    seconds: float  # that the reference may take
    budget: Budget


FULL = Plan(64, 1024, 64, 16384, 300.0, Budget(0.3, 5.0, tries=3))
QUICK = Plan(8, 1024, 16, 320, 5.0, Budget(0.0, 0.1, tries=1))


def fitting(scene: Scene, size: tuple[int, int], plan: Plan) -> tuple[int, int]:
    """The size of the pictures: as it is wanted, or halved until the plan's time is enough; by halves, so that it is
    mostly the same when it is worked out again."""
    renderer = Renderer()
    renderer.prepare(scene)
    width, height = scaled(size, min(1.0, plan.width / size[0]))
    pixels = np.zeros((height, width, 4), np.uint8)
    renderer.render(scene, pixels)
    once = min(runs(lambda: renderer.render(scene, pixels), 2, 0.0)).wall
    halvings = ceil(log2(once * plan.samples / plan.seconds) / 2)
    return scaled((width, height), 0.5 ** max(0, halvings))


def scaled(size: tuple[int, int], factor: float) -> tuple[int, int]:
    """A size times a factor, at least a pixel."""
    return max(1, round(size[0] * factor)), max(1, round(size[1] * factor))
