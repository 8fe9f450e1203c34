"""Rendering a turntable: pictures from all around the scene."""

from __future__ import annotations

import argparse
import struct
from collections.abc import Callable, Iterator
from itertools import islice
from math import prod
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, TypeVar

from minirt.cli.arguments import OK, SAMPLES
from minirt.cli.picture import rows_done, write
from minirt.cli.target import check_memory, check_region, is_film, needs_light
from minirt.helpers.progress import State, progress
from minirt.helpers.system import gc_paused

if TYPE_CHECKING:
    from minirt.cli.part_file import PartFile
    from minirt.image import Image
    from minirt.scene import Scene

Some = TypeVar("Some", bound="Frames")

SIZE = struct.Struct("<q")  # of a file that is written


def render_turntable(scene: Scene, options: argparse.Namespace) -> int:
    """Render the scene from all around it and write the film; show the progress on a terminal."""
    write_turntable(scene, options, Frames)
    return OK


def write_turntable(scene: Scene, options: argparse.Namespace, make: Callable[..., Some]) -> Some:
    """Write the film of the frames that `make` returns; its arguments are those of `Frames`."""
    import minirt
    from minirt.cli.arguments import Region
    from minirt.cli.work import kept_work
    from minirt.viewer.app.replay import turntable

    size = options.size or minirt.size_of(scene)
    check_region(options, options.output, *size)
    check_memory(options, options.output, size)
    wanted = options.frames or range(1, options.turntable + 1)
    region = options.region or Region(0, 0, *size)
    samples = 0 if options.samples == "auto" else options.samples or SAMPLES  # what that renders is not gone on with
    rays = region.width * region.height * samples * len(wanted)
    with gc_paused(), kept_work(scene, options, size, rays, len(wanted), "pictures of the film") as part:
        frames = make(turntable(scene, options.turntable), options, size, wanted, part)
        with progress(frames.state):
            if is_film(options):
                minirt.save_movie(frames.images(), options.output, quality=options.quality)
            else:
                frames.write()
    return frames


class Frames:
    """The pictures of a turntable, each rendered, or read from the part file of a program that was interrupted."""

    def __init__(
        self,
        views: Iterator[Scene],
        options: argparse.Namespace,
        size: tuple[int, int],
        wanted: range,
        part: PartFile | None,
    ) -> None:
        import minirt

        self.views: Iterator[Scene] = islice(views, wanted.start - 1, wanted.stop - 1)
        self.options = options
        self.size = size
        self.wanted = wanted
        self.part = part
        self.renderer = minirt.renderer(options.threads, options.precision, options.depth, options.dither)
        self.current, self.found = wanted.start, 0
        *_, across, down = options.region or size
        self.shape = down, across, 3

    def state(self) -> State:
        """Return how far this program is."""
        done = self.current - self.wanted.start - self.found + rows_done(self.renderer, self.shape[0])
        share = done / max(len(self.wanted) - self.found, 1)
        return State(f"picture {self.current} of {self.options.turntable}", max(share, 0.0))

    def numbered_views(self) -> Iterator[tuple[int, Scene]]:
        """Yield the number and the scene of each picture."""
        for number, view in zip(self.wanted, self.views, strict=True):
            self.current = number
            yield number, view

    def render(self, view: Scene) -> Image:
        """Render a picture."""
        import minirt

        options = self.options
        return minirt.render(
            view,
            *self.size,
            samples=options.samples or SAMPLES,
            threads=options.threads,
            precision=options.precision,
            depth=options.depth,
            dither=options.dither,
            linear=needs_light(options, options.output),
            region=options.region,
        )

    def images(self) -> Iterator[Image]:
        """Yield all pictures, and keep them in the part file."""
        import numpy as np

        from minirt.image import Image

        for number, view in self.numbered_views():
            data = self.part and self.part.read(number, prod(self.shape))
            if data:
                self.found += 1
                yield Image(np.frombuffer(data, np.uint8).reshape(self.shape))
                continue
            start = perf_counter()
            image = self.render(view)
            if self.part:
                self.part.offer(number, image.array.tobytes(), perf_counter() - start)
            yield image

    def write(self) -> None:
        """Write a file for each picture. The part file has the sizes of those that are written."""
        from minirt.movie import numbered

        for number, view in self.numbered_views():
            file = numbered(Path(self.options.output), number)
            size = self.part and self.part.read(number, SIZE.size)
            if size and is_written(file, size):
                self.found += 1
                continue
            start = perf_counter()
            write(self.render(view), str(file), view, self.options)
            if self.part:
                self.part.offer(number, SIZE.pack(file.stat().st_size), perf_counter() - start)


def is_written(file: Path, size: bytes) -> bool:
    """Whether there is a file of the size that the part file has."""
    return file.is_file() and file.stat().st_size == int(SIZE.unpack(size)[0])
