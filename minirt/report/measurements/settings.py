"""Table of the render settings that a report compares: one knob is turned at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import nan
from typing import NamedTuple

import numpy as np

from minirt.rendering import Renderer
from minirt.rendering.packing.features import DEPTH, features
from minirt.rendering.scene_packing import Packing
from minirt.report.measurements.brute_force import (
    ChangedPacking,
    without_boxes,
    without_light_buffers,
    without_tiles,
)
from minirt.scene import Scene

COUNTS = (1, 4, 16, 64)  # samples per pixel
MORE_COUNTS = (1, 2, 4, 8, 16, 32, 64)  # for a line whose order of convergence is wanted best
ERRORS = (0.01, 0.005, 0.002, 0.001, 0.0005)  # asked of automatic sampling


class Drawn(NamedTuple):
    """Settings with which a picture was drawn."""

    samples: float  # per pixel
    not_finite: int  # rays that brought light that is not finite
    asked: float = nan  # error that was asked for
    estimated: float = nan  # error by the estimate of automatic sampling


Picture = Callable[[Renderer, Scene, np.ndarray, float, "np.ndarray | None"], Drawn]


def uniform_samples(
    renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: float, linear: np.ndarray | None = None
) -> Drawn:
    """Render with the same number of samples in each pixel."""
    renderer.render(scene, pixels, int(samples), linear)
    return Drawn(samples, renderer.not_finite)


def adaptive_samples(
    renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: float, linear: np.ndarray | None = None
) -> Drawn:
    """Render one sample per pixel, then `samples` where neighbouring pixels differ."""
    renderer.render(scene, pixels, 1, linear)
    before = renderer.not_finite
    renderer.refine(scene, pixels, int(samples), linear=linear)
    return Drawn(samples, before + renderer.not_finite)


def automatic_samples(
    renderer: Renderer, scene: Scene, pixels: np.ndarray, error: float, linear: np.ndarray | None = None
) -> Drawn:
    """Render as `--samples auto` does until the estimated error is at most `error`."""
    outcome = renderer.reach(scene, pixels, error, linear=linear)
    assert outcome, "nobody cancels"
    return Drawn(outcome.samples, renderer.not_finite, error, outcome.error)


def brute_force(threads: int) -> Renderer:
    """Return a renderer that tests every ray against every shape."""
    renderer = Renderer(threads)
    renderer.packing = ChangedPacking(without_tiles, without_light_buffers, without_boxes)
    return renderer


class Knob(NamedTuple):
    """A render option that is varied: a line of the diagram."""

    name: str
    about: str
    renderer: Callable[[int], Renderer] = Renderer  # number of threads -> renderer
    picture: Picture = uniform_samples
    values: tuple[float, ...] = COUNTS  # samples, or errors that are asked for
    work: Callable[[float], float] = float  # value -> what the time is proportional to, at most


SINGLE = Knob("single", "float32 relative to the eye", renderer=lambda threads: Renderer(threads, "single"))
AUTO = Knob(
    "auto",
    "as many samples in each part of the picture as the error that is asked for needs (`--samples auto`)",
    picture=automatic_samples,
    values=ERRORS,
    work=lambda error: error**-1.5,
)
KNOBS = (
    Knob("uniform", "the same samples in each pixel, float64", values=MORE_COUNTS),
    Knob(
        "adaptive",
        "one sample, then more where neighbouring pixels differ",
        picture=adaptive_samples,
        values=COUNTS[1:],
    ),
    AUTO,
    SINGLE,
    Knob("brute force", "no culling: every ray tries every shape", renderer=brute_force, values=COUNTS[:2]),
)


def bounces(depth: int, name: str) -> Knob:
    """Uniform samples with at most `depth` bounces."""
    about = f"light is reflected or refracted {depth} times at most, not {DEPTH} times"
    return Knob(name, about, renderer=lambda threads: Renderer(threads, depth=depth), values=COUNTS[::2])


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
    """A knob with a number of samples, or with the error that is asked for: a point of the diagram."""

    knob: Knob
    value: float

    @property
    def label(self) -> str:
        """The value in words, such as `16`."""
        return f"{self.value:g}"

    @property
    def name(self) -> str:
        """Name of the setting, such as `uniform 16`."""
        return f"{self.knob.name} {self.label}"


def settings(scene: Scene, most: int, least_error: float) -> Iterator[Setting]:
    """Yield all settings of a scene with at most `most` samples, or errors of at least `least_error`, knob by knob."""
    for knob in knobs_of(scene):
        wanted = (value for value in knob.values if (value >= least_error if knob is AUTO else value <= most))
        yield from (Setting(knob, value) for value in wanted)
