"""The table of settings that are compared: one knob is turned at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from minirt.rendering import Renderer
from minirt.rendering.packing.features import DEPTH, features
from minirt.rendering.scene_packing import Packing
from minirt.report.measurements.brute_force import BruteForce
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


SINGLE = Knob("single", "float32 relative to the eye", renderer=lambda threads: Renderer(threads, "single"))
KNOBS = (
    Knob("uniform", "the same samples in each pixel, float64"),
    Knob("adaptive", "one sample, then more where neighbouring pixels differ", picture=at_edges, counts=COUNTS[1:]),
    SINGLE,
    Knob("brute force", "no lists: every ray tries every shape", renderer=brute_force, counts=COUNTS[:2]),
)


def bounces(depth: int, name: str) -> Knob:
    """As uniform, with so many bounces."""
    about = f"light is mirrored or refracted {depth} times at most, not {DEPTH} times"
    return Knob(name, about, renderer=lambda threads: Renderer(threads, depth=depth), counts=COUNTS[::2])


BOUNCES = (bounces(0, "no bounces"), bounces(1, "1 bounce"), bounces(3, "3 bounces"))


def knobs_of(scene: Scene) -> Iterator[Knob]:
    """Those that a scene has: what is float64 anyway has no other precision, and what is not mirrored does not
    bounce."""
    is_single = Packing(precision="single").pack(scene, 16, 9).camera.dtype == np.float32
    yield from (knob for knob in KNOBS if is_single or knob is not SINGLE)
    if "reflective" in features(scene):
        yield from BOUNCES


class Setting(NamedTuple):
    """A point of the diagram."""

    knob: Knob
    samples: int

    @property
    def name(self) -> str:
        """What it is called: uniform 16."""
        return f"{self.knob.name} {self.samples}"


def settings(scene: Scene, most: int) -> Iterator[Setting]:
    """All of a scene with at most so many samples, knob by knob."""
    for knob in knobs_of(scene):
        yield from (Setting(knob, samples) for samples in knob.counts if samples <= most)
