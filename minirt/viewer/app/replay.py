"""Replay: play recorded keys and mouse events without a window, in simulated time; films of replays."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from minirt.mlx.recording import add_recording
from minirt.rendering.image import Image
from minirt.rendering.renderer import Renderer
from minirt.scene import Scene
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.app.session import Session
from minirt.viewer.display.jobs import Pixels

FPS = 12  # frames per second of an animation
TICKS = 60  # per second of simulated time
ARROW = ((0, 0), (0, 17), (4, 13), (7, 20), (10, 19), (7, 12), (12, 12))  # corners of the pointer, in pixels


def replay(scene: Scene, lines: Iterable[str], *, hud: bool = True, **settings: Any) -> Pixels:
    """Play `lines` as `play` does, and return the last frame, (h, w, 4) BGRA; without `hud` the picture alone.

    The first error that the window showed is raised: of a command that failed, or of a picture that cannot be made.
    """
    session = play(scene, lines, **settings)
    if session.failures:
        raise session.failures[0]
    return session.screen.frame if hud else session.picture


def play(
    scene: Scene,
    lines: Iterable[str],
    *,
    renderer: Renderer,
    size: tuple[int, int],
    path: str | os.PathLike[str],
    file: str = "replay",
    keys: str = "qwerty",
    watch: Callable[[Session], object] = lambda _: None,
    **options: Any,
) -> Session:
    """Play `lines` (see `minirt.mlx.recording`) and return the session at the end.

    The same lines give the same frames. `path` is the scene's file, which keys may save and reload; `file` is the name
    of the recording in error messages. `watch` is called with the session sixty times per simulated second; `options`
    are those of `Session`.

    If a line is wrong, ReplayError is raised before any line is played. Errors of commands, such as saving, are in the
    session; `replay` and `record` raise the first at the end.
    """
    memory = Memory()
    add_recording(lines, file, memory)
    mlx = Mlx(memory)
    display = mlx.mlx_init()
    session = Session(mlx, display, scene, Path(path), size, renderer, keys=keys, **options)
    EventDispatcher(session)
    session.screen.handles = True
    memory.after_tick = lambda: watch(session)
    try:
        memory.play()
    finally:
        mlx.mlx_release(display)
    return session


def record(scene: Scene, lines: Iterable[str], add: Callable[[Image], object], **settings: Any) -> None:
    """Give the frames of a replay to a function, FPS per simulated second, with the pointer while it is used.

    The other arguments and the errors are those of `replay`.
    """
    ticks = itertools.count()

    def add_frame(session: Session) -> None:
        if next(ticks) % (TICKS // FPS) == 0:
            add(Image.from_bgra(with_pointer(session.screen.frame, session.window.pointer)))

    add(Image.from_bgra(replay(scene, lines, watch=add_frame, **settings)))


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
