"""Replay: play recorded keys and mouse events on the viewer without a window, in simulated time."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from minirt.scene import Scene
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.app.session import Session
from minirt.viewer.display.painter import Painter, Pixels, Renderer
from minirt.viewer.input.recording import add_recording


def replay(
    scene: Scene,
    lines: Iterable[str],
    *,
    renderer: Renderer,
    size: tuple[int, int],
    path: str | os.PathLike[str],
    file: str = "replay",
    keys: str = "qwerty",
    lenient: bool = False,
    samples: int = 1,
    hud: bool = True,
) -> Pixels:
    """Play `lines` (see `minirt.viewer.input.recording`) and return the last frame, (h, w, 4) BGRA.

    Without `hud` the frame is the picture alone. The same lines give the same frame. `path` is the scene's file, which
    keys may save and reload; `file` is the name of the recording in error messages. If a line is wrong, ReplayError is
    raised before any line is played; if a command fails, such as saving, its error is raised at the end.
    """
    session = play(
        scene, lines, renderer=renderer, size=size, path=path, file=file, keys=keys, lenient=lenient, samples=samples
    )
    raise_failure(session)
    return session.screen.frame if hud else session.picture


def raise_failure(session: Session) -> None:
    """Raise the error of the first command that failed, if there is one."""
    if session.failures:
        raise session.failures[0]


def play(
    scene: Scene,
    lines: Iterable[str],
    *,
    renderer: Renderer,
    size: tuple[int, int],
    path: str | os.PathLike[str],
    file: str = "replay",
    keys: str = "qwerty",
    lenient: bool = False,
    samples: int = 1,
    watch: Callable[[Session], object] = lambda _: None,
) -> Session:
    """Play `lines` as `replay` does and return the session at the end.

    `watch` is called with the session sixty times per simulated second.
    """
    memory = Memory()
    add_recording(lines, file, memory)
    mlx = Mlx(memory)
    display = mlx.mlx_init()
    session = Session(
        mlx, display, scene, path=Path(path), size=size, painter=partial(Painter, renderer), pick=renderer.pick,
        keys=keys, lenient=lenient, samples=samples,
    )  # fmt: skip
    EventDispatcher(session).connect()
    memory.after_tick = lambda: watch(session)
    try:
        memory.play()
    finally:
        mlx.mlx_release(display)
    return session
