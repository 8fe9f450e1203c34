"""A picture that is made of bands, each a task of its own."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from functools import cached_property

import minirt
from minirt.cluster.bands import bands_of
from minirt.cluster.dispatch import Dispatcher, Job
from minirt.cluster.parcel import Parcel, pack
from minirt.cluster.task import Made, Region, Settings, Task, version
from minirt.cluster.workers import WorkerPool
from minirt.errors import RenderError
from minirt.rendering.packing.camera import cut_for
from minirt.scene import Scene


class Still:
    """A picture, or a region of it, in a form of `minirt.cluster.worker.FORMS`."""

    def __init__(self, scene: Scene, settings: Settings, region: Region | None, form: str) -> None:
        """RenderError where the settings do not go together."""
        width, height, samples, error, *_ = settings
        if width < 1 or height < 1:
            raise RenderError(f"a picture has at least 1x1 pixels, got {width}x{height}")
        if error is not None and samples != "auto":
            raise RenderError(f"an error needs samples='auto', got {samples}")
        cut_for(region, width, height)
        self.scene = scene
        self.settings = settings
        self.region = region or (0, 0, width, height)
        self.form = form
        self.bands = bands_of(self.region)

    @cached_property
    def task(self) -> Task:
        """The task of rendering all of it."""
        return Task(version(), self.parcel.digest, self.parcel.files, self.settings, self.form, region=self.region)

    @cached_property
    def parcel(self) -> Parcel:
        """The scene; FileError where one of its files cannot be read."""
        return pack(self.scene)

    def made(self, pool: WorkerPool, done: Collection[int] = ()) -> Iterator[tuple[int, Made]]:
        """Yield the numbers and the results of the bands that are not done, as they come. RenderError."""
        todo = ((number, band) for number, band in enumerate(self.bands) if number not in done)
        return Dispatcher(pool).results(Job(n, self.task._replace(region=band), self.parcel) for n, band in todo)


def size_for(scene: Scene, width: int | None, height: int | None) -> tuple[int, int]:
    """Return the size that is asked for, or the scene's own."""
    own_width, own_height = minirt.size_of(scene)
    return own_width if width is None else width, own_height if height is None else height
