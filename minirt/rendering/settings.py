"""Settings of a picture, the same for the library, the command line, workers and journals."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

from minirt.errors import RenderError
from minirt.records import Immutable, record
from minirt.rendering.packing.camera import Region
from minirt.rendering.renderer import Renderer, shared_renderer


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
            if value is not None and not value > 0:
                raise RenderError(f"{name} must be > 0, got {value}")

    def replace(self, **changes: Any) -> RenderSettings:
        """Return the settings with some of them changed."""
        return replace(self, **changes)

    @property
    def renderer(self) -> Renderer:
        """The renderer that all pictures with these threads, precision, depth and dithering share."""
        return shared_renderer(self.threads, self.precision, self.depth, self.dither)
