"""Table of the render settings that a report compares: one knob is turned at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from minirt.rendering import Renderer
from minirt.rendering.packing.features import DEPTH, features
from minirt.rendering.scene_packing import Packing
from minirt.report.measurements.brute_force import BruteForce
from minirt.scene import Scene

COUNTS = (1, 4, 16, 64)  # samples per pixel
Picture = Callable[[Renderer, Scene, np.ndarray, int, "np.ndarray | None"], int]


def uniform_samples(
    renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: int, linear: np.ndarray | None = None
) -> int:
    """Render with the same number of samples in each pixel; return how many rays brought light that is not finite."""
    renderer.render(scene, pixels, samples, linear)
    return renderer.not_finite


def adaptive_samples(
    renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: int, linear: np.ndarray | None = None
) -> int:
    """Render one sample per pixel, then `samples` where neighbouring pixels differ; return as `uniform_samples`."""
    renderer.render(scene, pixels, 1, linear)
    before = renderer.not_finite
    renderer.refine(scene, pixels, samples, linear=linear)
    return before + renderer.not_finite


def brute_force(threads: int) -> Renderer:
    """Return a renderer that tests every ray against every shape."""
    renderer = Renderer(threads)
    renderer.packing = BruteForce()
    return renderer


class Knob(NamedTuple):
    """A render option that is varied: a line of the diagram."""

    name: str
    about: str
    renderer: Callable[[int], Renderer] = Renderer  # number of threads -> renderer
    picture: Picture = uniform_samples
    counts: tuple[int, ...] = COUNTS


SINGLE = Knob("single", "float32 relative to the eye", renderer=lambda threads: Renderer(threads, "single"))
KNOBS = (
    Knob("uniform", "the same samples in each pixel, float64"),
    Knob(
        "adaptive",
        "one sample, then more where neighbouring pixels differ",
        picture=adaptive_samples,
        counts=COUNTS[1:],
    ),
    SINGLE,
    Knob("brute force", "no culling: every ray tries every shape", renderer=brute_force, counts=COUNTS[:2]),
)


def bounces(depth: int, name: str) -> Knob:
    """Uniform samples with at most `depth` bounces."""
    about = f"light is reflected or refracted {depth} times at most, not {DEPTH} times"
    return Knob(name, about, renderer=lambda threads: Renderer(threads, depth=depth), counts=COUNTS[::2])


BOUNCES = (bounces(0, "no bounces"), bounces(1, "1 bounce"), bounces(3, "3 bounces"))


def knobs_of(scene: Scene) -> Iterator[Knob]:
    """Yield the knobs that change something in a scene.

    Single precision is left out if the scene needs float64, bounces if nothing reflects or refracts.
    """
    is_single = Packing(precision="single").pack(scene, 16, 9).camera.dtype == np.float32
    yield from (knob for knob in KNOBS if is_single or knob is not SINGLE)
    if "reflective" in features(scene):
        yield from BOUNCES


class Setting(NamedTuple):
    """A knob with a number of samples: a point of the diagram."""

    knob: Knob
    samples: int

    @property
    def name(self) -> str:
        """Name of the setting, such as `uniform 16`."""
        return f"{self.knob.name} {self.samples}"


def settings(scene: Scene, most: int) -> Iterator[Setting]:
    """Yield all settings of a scene with at most `most` samples, knob by knob."""
    for knob in knobs_of(scene):
        yield from (Setting(knob, samples) for samples in knob.counts if samples <= most)
