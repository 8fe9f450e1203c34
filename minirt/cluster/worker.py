"""Work of a worker: find the scene of a task, render, and return levels, light, or parts of a TIFF file."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

import minirt
from minirt.cluster import files, parcel
from minirt.cluster.task import Answer, Made, Missing, Task, version
from minirt.errors import RenderError
from minirt.formats import tiff
from minirt.helpers.system import ForkSafeLock
from minirt.scene import Scene

if TYPE_CHECKING:
    from minirt.image import Image

SCENES = 4  # kept in memory

scenes: dict[str, Scene] = {}  # by digest, the one that was used last at the end
lock = ForkSafeLock()


def levels(image: Image) -> Made:
    """Return a picture of 8 bits as it is."""
    return Made((image.array,), (), image.reached)


def levels_and_light(image: Image) -> Made:
    """Return a picture with its light."""
    return Made((image.array, image.light("light")), (), image.reached)


def strips_of_8_bits(image: Image) -> Made:
    """Return a picture as strips of a TIFF file."""
    return Made((), tiff.strips(image.array), image.reached)


def strips_of_16_bits(image: Image) -> Made:
    """Return a picture as strips of a TIFF file, made of its light."""
    return Made((), tiff.strips(image.deep), image.reached)


FORMS: dict[str, tuple[bool, Callable[[Image], Made]]] = {  # whether light is needed, and what makes the result
    "levels": (False, levels),
    "light": (True, levels_and_light),
    "strips-8": (False, strips_of_8_bits),
    "strips-16": (True, strips_of_16_bits),
}


def carry_out(task: Task) -> Answer:
    """Carry out a task, or say which contents are missing. RenderError where this is another version of the program."""
    if task.version != version():
        raise RenderError(f"a worker has another miniRT: {version()} in place of {task.version}")
    scene = scene_of(task)
    if isinstance(scene, Missing):
        return scene
    if task.camera is not None:
        scene = scene.replace(scene.camera, task.camera)
    needs_light, finish = FORMS[task.form]
    width, height, samples, *_ = task.settings
    image = minirt.render(
        scene,
        width,
        height,
        samples=samples,
        error=task.settings.error,
        time=task.settings.time,
        threads=task.threads or share_of_cores(),
        precision=task.settings.precision,
        depth=task.settings.depth,
        linear=needs_light,
        dither=task.settings.dither,
        region=task.region,
    )
    return finish(image)


def scene_of(task: Task) -> Scene | Missing:
    """Return the scene of a task, from memory if it is there; or what must be sent first."""
    with lock:
        scene = scenes.pop(task.scene, None)
        if scene is None:
            for digest in set(task.files) & set(task.sent):
                files.keep(task.sent[digest])
            missing = [each for each in task.files if not files.has(each)]
            if task.scene not in task.sent:
                missing.append(task.scene)
            if missing:
                return Missing(tuple(missing))
            scene = parcel.unpack(task.sent[task.scene])
        scenes[task.scene] = scene
        for each in list(scenes)[:-SCENES]:
            del scenes[each]
        return scene


def share_of_cores() -> int | None:
    """Return the number of threads that a dask worker has; None elsewhere: all processors."""
    if "distributed" not in sys.modules:
        return None
    from distributed import get_worker

    try:
        return int(get_worker().state.nthreads)
    except ValueError:  # not called by a worker
        return None
