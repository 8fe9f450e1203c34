"""Settings of a picture, and rendering it: the same for the library, the command line, workers and journals."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from numbers import Real
from typing import Any, Literal

import numpy as np

from minirt.errors import RenderError, check_whole
from minirt.helpers import system
from minirt.helpers.progress import State, in_notebooks
from minirt.records import Immutable, record
from minirt.rendering.image import Image, LinearImage
from minirt.rendering.packing.camera import Region, cut_for
from minirt.rendering.renderer import Renderer, renderer
from minirt.scene import Scene

DEFAULT_ERROR = 0.002  # half a level of 255: the least that a picture of bytes can show
CANCELLED = "the picture was cancelled"  # by `minirt.renderer(...).cancel()`, from another thread
PIXEL, LIGHT = 4, 24  # bytes of a pixel and of its light, while they are rendered


@record()
class RenderSettings(Immutable):
    """The keywords of `minirt.render`, which explains them; RenderError where they do not go together."""

    samples: int | Literal["auto"] = 1  # rays a pixel
    error: float | None = None  # RMSE at which samples="auto" end
    time: float | None = None  # seconds after which they end
    threads: int | None = None  # None: one for each processor
    precision: Literal["double", "single"] = "double"
    depth: int | None = None  # of reflections and refractions; None: 8
    linear: bool = True  # whether the picture has its light, too
    dither: bool = False  # whether blue noise replaces rounding to 8 bits
    region: Region | None = None  # None: the whole picture

    def __post_init__(self) -> None:
        for name, value in (("error", self.error), ("time", self.time)):
            if value is not None and self.samples != "auto":
                raise RenderError(f"an error or a time needs samples='auto', got {self.samples}")
            if value is not None and not (isinstance(value, Real) and value > 0):
                raise RenderError(f"{name} must be a number > 0, got {value!r}")
        if self.samples != "auto":
            check_whole("samples", self.samples, 1)

    def replace(self, **changes: Any) -> RenderSettings:
        """Return the settings with some of them changed."""
        return replace(self, **changes)

    @property
    def renderer(self) -> Renderer:
        """The renderer that all pictures with these threads, precision, depth and dithering share."""
        return renderer(self.threads, self.precision, self.depth, self.dither)


def rendered(scene: Scene, size: tuple[int, int], settings: RenderSettings) -> Image:
    """Return the picture of a scene: what `minirt.render` returns. RenderError."""
    crop, shape, kept, _ = cut_for(settings.region, *size)
    system.check_picture(*shape, PIXEL + LIGHT * (settings.linear or settings.dither))
    pixels = np.empty((*shape, 4), np.uint8)
    light = np.zeros((*shape, 3)) if settings.linear else None
    chosen = settings.renderer
    reached = None
    if settings.samples == "auto":
        default = DEFAULT_ERROR if settings.time is None else 0.0
        goal = settings.error or default, inf if settings.time is None else settings.time
        if settings.time is not None:
            chosen.prepare(scene)
        with in_notebooks(lambda: State("sampling")):
            reached = chosen.reach(scene, pixels, *goal, light, crop)
        is_done = reached is not None
    else:
        with in_notebooks(lambda: State("picture", chosen.rows_done(len(pixels)))):
            is_done = chosen.render(scene, pixels, settings.samples, light, crop=crop)
    if not is_done:
        raise RenderError(CANCELLED)
    if light is None:
        return Image.from_bgra(pixels[kept], None, reached, scene.camera.tone)
    return LinearImage.from_bgra(pixels[kept], np.ascontiguousarray(light[kept]), reached, scene.camera.tone)
