"""Turntables whose pictures are rendered by several processes of this machine, or by the workers of a dask cluster."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from functools import cached_property, partial
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

from minirt.cli.arguments import SAMPLES
from minirt.cli.cluster import status, workers
from minirt.cli.target import is_film, needs_light
from minirt.cli.turntable import SIZE, Frames, is_written, write_turntable
from minirt.helpers.progress import State

if TYPE_CHECKING:
    from minirt.image import Image
    from minirt.rendering.outcome import Outcome
    from minirt.scene import Scene


def render_frames(scene: Scene, options: argparse.Namespace) -> int:
    """Render a turntable and write the film."""
    with workers(options) as executor:
        frames = write_turntable(scene, options, partial(FramesByWorkers, executor))
    return status(max(frames.outcomes, key=lambda each: each.error, default=None), options)


class FramesByWorkers(Frames):
    """The pictures of a turntable that workers render; those of a part file are not rendered again."""

    def __init__(self, executor: Any, views: Iterator[Scene], *arguments: Any) -> None:
        super().__init__(views, *arguments)
        self.executor = executor
        self.scenes = list(self.views)
        self.views = iter(self.scenes)
        self.outcomes: list[Outcome] = []

    def state(self) -> State:
        """Return how far this program is."""
        done = self.current - self.wanted.start - self.found
        return State(
            f"picture {self.current} of {self.options.turntable}", done / max(1, len(self.wanted) - self.found)
        )

    @cached_property
    def missing(self) -> list[Scene]:
        """The scenes that are to be rendered."""
        return [view for number, view in zip(self.wanted, self.scenes, strict=True) if not self.is_kept(number)]

    def is_kept(self, number: int) -> bool:
        """Whether an interrupted program has left a picture."""
        from minirt.movie import numbered

        if not self.part:
            return False
        if is_film(self.options):
            return self.part.read(number, prod(self.shape)) is not None
        size = self.part.read(number, SIZE.size)
        return size is not None and is_written(numbered(Path(self.options.output), number), size)

    @cached_property
    def pictures(self) -> Iterator[Image]:
        """The pictures of the scenes that are missing, in their order."""
        import minirt

        options = self.options
        return minirt.render_all(
            self.missing,
            *self.size,
            executor=self.executor,
            samples=options.samples or SAMPLES,
            error=options.error,
            threads=options.threads,
            precision=options.precision,
            depth=options.depth,
            linear=needs_light(options, options.output),
            dither=options.dither,
            region=options.region,
        )

    def render(self, view: Scene) -> Image:
        """Return the picture of the next scene that is missing."""
        image = next(self.pictures)
        if image.reached:
            self.outcomes.append(image.reached)
        return image
