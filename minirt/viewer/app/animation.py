"""Animation frames: a turntable of a scene, and the frames of a replay."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from minirt.image import Image
from minirt.scene import Scene
from minirt.viewer.app.replay import play, raise_failure
from minirt.viewer.app.session import Session
from minirt.viewer.display.painter import Pixels, Renderer
from minirt.viewer.editing.measure import scene_centre
from minirt.viewer.editing.motion import orbit_camera

FPS = 12  # frames per second of an animation
TICKS = 60  # per second of simulated time
ARROW = ((0, 0), (0, 17), (4, 13), (7, 20), (10, 19), (7, 12), (12, 12))  # corners of the pointer, in pixels


def turntable(scene: Scene, count: int) -> Iterator[Scene]:
    """Yield the scene from `count` positions on a circle around its centre; the frames repeat seamlessly."""
    pivot = scene_centre(scene)
    for number in range(count):
        camera = orbit_camera(scene.camera, pivot, 360.0 * number / count, 0.0)
        yield scene.replace(scene.camera, camera) if number else scene


def animation(scene: Scene, lines: Iterable[str], **settings: Any) -> list[Image]:
    """Return the frames of a replay; the arguments are those of `record`."""
    frames: list[Image] = []
    record(scene, lines, frames.append, **settings)
    return frames


def record(
    scene: Scene,
    lines: Iterable[str],
    add: Callable[[Image], object],
    *,
    renderer: Renderer,
    size: tuple[int, int],
    path: str | os.PathLike[str],
    file: str = "replay",
    keys: str = "qwerty",
    lenient: bool = False,
    samples: int = 1,
) -> None:
    """Give the frames of a replay to a function, FPS per simulated second, with the pointer while it is used.

    Errors as for `minirt.viewer.app.replay.replay`.
    """
    ticks = itertools.count()

    def add_frame(session: Session) -> None:
        if next(ticks) % (TICKS // FPS) == 0:
            add(Image.from_bgra(with_pointer(session.screen.frame, session.window.pointer)))

    session = play(
        scene, lines, renderer=renderer, size=size, path=path, file=file, keys=keys, lenient=lenient, samples=samples,
        watch=add_frame,
    )  # fmt: skip
    raise_failure(session)
    add(Image.from_bgra(session.screen.frame))


def with_pointer(pixels: Pixels, at: tuple[int, int]) -> Pixels:
    """Return a copy of the picture with an arrow at pixel `at`; no arrow at (0, 0), where the pointer starts."""
    if at == (0, 0):
        return pixels
    from PIL import Image as pillow  # noqa: N813
    from PIL import ImageDraw

    canvas = pillow.fromarray(pixels)
    corners = [(at[0] + x, at[1] + y) for x, y in ARROW]
    ImageDraw.Draw(canvas).polygon(corners, fill=(255, 255, 255, 255), outline=(0, 0, 0, 255))
    return np.asarray(canvas)
