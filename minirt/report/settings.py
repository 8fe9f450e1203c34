"""Settings that a report varies: samples per pixel, adaptive and automatic sampling, precision and bounces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from minirt.rendering.packing.features import DEPTH, features
from minirt.rendering.renderer import Renderer
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene

COUNTS = (1, 4, 16, 64)  # samples per pixel
MORE_COUNTS = (1, 2, 4, 8, 16, 32, 64)  # for a line whose order of convergence is wanted best
ERRORS = (0.01, 0.005, 0.003, 0.002, 0.001, 0.0005)  # asked of automatic sampling
ONE_SAMPLE = 0.02  # a usual error of a picture with one sample per pixel

Drawn = dict[str, Any]  # how a picture was drawn, by fields of `minirt.report.pictures.Row`
Linear = np.ndarray | None
Draw = Callable[[Renderer, Scene, np.ndarray, float, Linear], Drawn]


def uniform_samples(renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: float, linear: Linear) -> Drawn:
    """Render with the same number of samples in each pixel."""
    renderer.render(scene, pixels, int(samples), linear)
    return {"samples": samples, "not_finite": renderer.not_finite}


def adaptive_samples(renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: float, linear: Linear) -> Drawn:
    """Render one sample per pixel, then `samples` where neighbouring pixels differ."""
    renderer.render(scene, pixels, 1, linear)
    before = renderer.not_finite
    renderer.render(scene, pixels, int(samples), linear, edges_only=True)
    return {"samples": samples, "not_finite": before + renderer.not_finite}


def automatic_samples(renderer: Renderer, scene: Scene, pixels: np.ndarray, error: float, linear: Linear) -> Drawn:
    """Render as `--samples auto` does until the estimated error is at most `error`."""
    found = renderer.reach(scene, pixels, error, linear=linear)
    assert found, "nobody cancels"
    return {"samples": found.samples, "asked": error, "estimated": found.error, "not_finite": renderer.not_finite}


class Knob(NamedTuple):
    """A render option that is varied: a line of the diagram."""

    name: str
    about: str
    renderer: Mapping[str, Any] = {}  # keywords of its renderer
    draw: Draw = uniform_samples
    values: tuple[float, ...] = COUNTS  # samples, or errors that are asked for
    work: Callable[[float], float] = float  # value -> samples per pixel, at most, to which the time is proportional
    per_sample: float = 1.0  # usual time of a sample, by that of `UNIFORM`


OPTIONS = {uniform_samples: "--samples {:g}", automatic_samples: "--samples auto --error {:g}"}  # of the command line
UNIFORM = Knob("uniform", "the same samples in each pixel, float64", values=MORE_COUNTS)
ADAPTIVE = Knob("adaptive", "one sample, then more where neighbouring pixels differ", {}, adaptive_samples, COUNTS[1:])
SINGLE = Knob("single", "float32 relative to the eye", {"precision": "single"}, per_sample=0.55)
AUTO = Knob(
    "auto",
    "as many samples in each part of the picture as the error that is asked for needs (`--samples auto`)",
    draw=automatic_samples,
    values=ERRORS,
    work=lambda error: (ONE_SAMPLE / error) ** 1.5,
    per_sample=2.0,
)
ABOUT_BOUNCES = "reflections and refractions of a ray: {} at most, not {}"
BOUNCES = tuple(
    Knob(name, ABOUT_BOUNCES.format(depth, DEPTH), {"depth": depth}, values=COUNTS[::2])
    for depth, name in ((0, "no bounces"), (1, "1 bounce"), (3, "3 bounces"))
)
KNOBS = (UNIFORM, ADAPTIVE, AUTO, SINGLE, *BOUNCES)  # the simplest first


class Setting(NamedTuple):
    """A knob with a number of samples, or with the error that is asked for: a point of the diagram."""

    knob: Knob
    value: float

    @property
    def name(self) -> str:
        """Name of the setting, such as `uniform 16`."""
        return f"{self.knob.name} {self.value:g}"

    @property
    def options(self) -> str:
        """The options of the command line that draw so, such as `--samples 16`; empty where none do."""
        if self.knob.draw not in OPTIONS:
            return ""
        others = (f" --{name} {value}" for name, value in self.knob.renderer.items())
        return OPTIONS[self.knob.draw].format(self.value) + "".join(others)


def settings(scene: Scene, most: int, least_error: float) -> Iterator[Setting]:
    """Yield all settings of a scene with at most `most` samples, or errors of at least `least_error`, knob by knob.

    Single precision is left out if the scene needs float64, bounces if nothing reflects or refracts.
    """
    is_single = Packing(precision="single").pack(scene, 16, 9).camera.dtype == np.float32
    for knob in KNOBS:
        if (is_single or knob is not SINGLE) and ("reflective" in features(scene) or knob not in BOUNCES):
            wanted = (value for value in knob.values if (value >= least_error if knob is AUTO else value <= most))
            yield from (Setting(knob, value) for value in wanted)
