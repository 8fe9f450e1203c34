"""The table of settings that are compared: one knob is turned at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from minirt.rendering import Renderer
from minirt.report.brute import BruteForce
from minirt.scene import Scene

COUNTS = (1, 4, 16, 64)  # samples of a pixel
Picture = Callable[[Renderer, Scene, np.ndarray, int, "np.ndarray | None"], int]


def everywhere(
    renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: int, linear: np.ndarray | None = None
) -> int:
    """As many samples in each pixel; how many of the rays brought light that is not finite."""
    renderer.render(scene, pixels, samples, linear)
    return renderer.not_finite


def at_edges(
    renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: int, linear: np.ndarray | None = None
) -> int:
    """One sample in each pixel, and then so many where neighbours differ."""
    renderer.render(scene, pixels, 1, linear)
    before = renderer.not_finite
    renderer.refine(scene, pixels, samples, linear=linear)
    return before + renderer.not_finite


def brute_force(threads: int) -> Renderer:
    """A renderer that tries every shape for every ray."""
    renderer = Renderer(threads)
    renderer.packing = BruteForce()
    return renderer


class Knob(NamedTuple):
    """A line of the diagram."""

    name: str
    about: str
    renderer: Callable[[int], Renderer] = Renderer  # for a number of threads
    picture: Picture = everywhere
    counts: tuple[int, ...] = COUNTS


KNOBS = (
    Knob("uniform", "the same samples in each pixel, float64"),
    Knob("adaptive", "one sample, then more where neighbouring pixels differ", picture=at_edges, counts=COUNTS[1:]),
    Knob("single", "float32 relative to the eye", renderer=lambda threads: Renderer(threads, "single")),
    Knob("brute force", "no lists: every ray tries every shape", renderer=brute_force, counts=COUNTS[:2]),
)


class Setting(NamedTuple):
    """A point of the diagram."""

    knob: Knob
    samples: int

    @property
    def name(self) -> str:
        """What it is called: uniform 16."""
        return f"{self.knob.name} {self.samples}"


def settings(most: int) -> Iterator[Setting]:
    """All with at most so many samples, knob by knob."""
    for knob in KNOBS:
        yield from (Setting(knob, samples) for samples in knob.counts if samples <= most)
