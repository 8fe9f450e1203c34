"""Plays recorded keys on the viewer without a window: what the user would see, with simulated time."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from minirt.scene import Scene
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
    """Play `lines` (see `minirt.viewer.input.recording`) and return the last frame, (h, w, 4) BGRA; without `hud` its picture
    alone. The same lines give the same frame.

    `path` is the scene's file, which keys may save and reload; `file` is what errors call the lines. ReplayError where
    they cannot be played, before anything is done.
    """
    session = play(
        scene, lines, renderer=renderer, size=size, path=path, file=file, keys=keys, lenient=lenient, samples=samples
    )
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
    lenient: bool = False,
    samples: int = 1,
    watch: Callable[[Session], object] = lambda _: None,
) -> Session:
    """Like `replay`; returns the session as it is at the end. `watch` sees it sixty times a simulated second."""
    memory = Memory()
    add_recording(lines, file, memory)
    m = Mlx(memory)
    display = m.mlx_init()
    session = Session(
        m, display, scene, path=Path(path), size=size, painter=partial(Painter, renderer), pick=renderer.pick,
        keys=keys, lenient=lenient, samples=samples,
    )  # fmt: skip
    memory.after_tick = lambda: watch(session)
    try:
        memory.play()
    finally:
        m.mlx_release(display)
    return session
