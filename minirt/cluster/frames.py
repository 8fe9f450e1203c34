"""Renders many scenes on all workers of an executor, such as the frames of a film, in their order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal

from minirt.cluster.dispatch import Dispatcher, Job
from minirt.cluster.parcel import Parcel, pack
from minirt.cluster.still import size_for
from minirt.cluster.task import Region, Settings, Task, version
from minirt.cluster.workers import WorkerPool, Workers
from minirt.image import Image, LinearImage
from minirt.scene import Camera, Scene
from minirt.scene.scene import check_scene


def render_all(
    scenes: Iterable[Scene],
    width: int | None = None,
    height: int | None = None,
    *,
    executor: Workers | None = None,
    samples: int | Literal["auto"] = 1,
    error: float | None = None,
    time: float | None = None,
    threads: int | None = None,
    precision: Literal["double", "single"] = "double",
    depth: int | None = None,
    linear: bool = False,
    dither: bool = False,
    region: Region | None = None,
) -> Iterator[Image]:
    """Render scenes, such as the frames of a film or the steps of a sweep, and yield their pictures in order.

    A scene is a task; a few scenes are taken ahead of the picture that is waited for. The executor is that of
    `render_to`, the other arguments are those of `render`, without a size that of the first scene; the pictures are
    those of `render`, whoever renders them. Scenes that differ from the one before in the camera alone send just that.
    RenderError when rendering fails.
    """
    packer = Packer()
    tones: list[str] = []

    def jobs() -> Iterator[Job]:
        size = None
        for number, scene in enumerate(scenes):
            check_scene(scene, "render_all")
            size = size or size_for(scene, width, height)
            parcel = packer.pack(scene)
            settings = Settings(*size, samples, error, time, precision, depth, dither)
            form = "light" if linear else "levels"
            tones.append(scene.camera.tone)
            task = Task(version(), parcel.digest, parcel.files, settings, form, scene.camera, region)
            yield Job(number, task, parcel)

    for number, made in Dispatcher(WorkerPool(executor, threads), in_order=True).results(jobs()):
        levels, *light = made.arrays
        tone = tones[number]
        yield LinearImage(levels, light[0], made.reached, tone) if light else Image(levels, None, made.reached, tone)


class Packer:
    """Packs scene after scene; scenes that differ in the camera alone share a parcel."""

    def __init__(self) -> None:
        self.last: tuple[object, Parcel] | None = None

    def pack(self, scene: Scene) -> Parcel:
        """Return the parcel of a scene, whose camera may be another."""
        others = scene.file, [each for each in scene.elements if not isinstance(each, Camera)]
        if self.last is None or self.last[0] != others:
            self.last = others, pack(scene)
        return self.last[1]
