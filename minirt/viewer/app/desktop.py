"""The viewer as a program: it opens the window, runs the loop and leaves."""

from __future__ import annotations

import os
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import minirt
from minirt.gc_pause import gc_paused
from minirt.mlx import Mlx
from minirt.scene import Scene
from minirt.viewer.app.session import Session
from minirt.viewer.display.background_painter import BackgroundPainter
from minirt.viewer.display.painter import Renderer
from minirt.viewer.files.scene_files import differ, recover

if TYPE_CHECKING:
    from minirt.mlx.display import Display

OK, INTERRUPTED = 0, 130
PATIENCE = 0.3  # seconds that a picture under way has to notice that it is cancelled
SWITCH = 0.0005  # seconds that another thread may keep the interpreter: the loop takes it back ten times a turn


def run(
    scene: Scene,
    *,
    path: str | os.PathLike[str],
    size: tuple[int, int] | None = None,
    threads: int | None = None,
    keys: str = "auto",
    lenient: bool = False,
    samples: int = 1,
    renderer: Renderer | None = None,
    mlx: Mlx | None = None,
    watch: bool = True,
) -> int:
    """Show a scene until the user has seen enough; returns the exit status: 0, or 130 after Ctrl+C.

    `path` is the scene's file; with `watch` it is read again when another program changes it. Changes that were not
    saved are kept in a file that standard output names. When nothing moves the edges in the picture are refined to
    `samples` rays for each pixel.

    MlxError where no window can be opened, RenderError where the pictures cannot be made.

    Where the renderer cannot be stopped (inside the compiler) the process ends here and now.
    """
    maker = renderer or minirt.renderer(threads)
    session = started(scene, Path(path), size, maker, mlx or Mlx(), keys, lenient, samples, watch)
    try:
        status, stopped = show(session)
    finally:
        if differ(session.state.scene, session.saved):
            print(f"The changes that were not saved are in {recover(session.state.scene, session.path)}")
    if not stopped:
        leave(status)
    return status


def view(
    scene: Scene,
    size: tuple[int, int] | None = None,
    *,
    samples: int = 16,
    threads: int | None = None,
    precision: str = "double",
    keys: str = "auto",
    mlx: Mlx | None = None,
) -> Scene:
    """Show a scene in a window until it is closed; returns the scene as it was edited there.

    Ctrl+S in the window writes the file that the scene was read from, or `scene.rt`. The rest is as for `run` and for
    `minirt.render`.
    """
    maker = minirt.renderer(threads, precision)
    path = scene.file or Path("scene.rt")
    session = started(scene, path, size, maker, mlx or Mlx(), keys, lenient=False, samples=samples, watch=False)
    status, _ = show(session)
    if status == INTERRUPTED:
        raise KeyboardInterrupt
    return session.state.scene


def started(
    scene: Scene,
    path: Path,
    size: tuple[int, int] | None,
    maker: Renderer,
    m: Mlx,
    keys: str,
    lenient: bool,
    samples: int,
    watch: bool,
) -> Session:
    """A session with its window open. MlxError."""
    display = m.mlx_init()
    try:
        with gc_paused():
            return Session(
                m,
                display,
                scene,
                path=path,
                size=fitting(m, display, size or minirt.size_of(scene)),
                painter=partial(BackgroundPainter, maker),
                pick=maker.pick,
                keys=keys,
                lenient=lenient,
                samples=samples,
                watch=watch,
            )
    except BaseException:
        m.mlx_release(display)
        raise


def show(session: Session) -> tuple[int, bool]:
    """Run the loop until it ends; returns the exit status, and whether nothing is left behind, not even a thread."""
    status = OK
    before = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH)
    try:
        session.m.mlx_loop(session.mlx)
    except KeyboardInterrupt:
        status = INTERRUPTED
    finally:
        sys.setswitchinterval(before)
        session.m.mlx_release(session.mlx)
        session.disk.close()
        stopped = session.pictures.painter.close(PATIENCE)
    return status, stopped


def fitting(m: Mlx, display: Display, size: tuple[int, int]) -> tuple[int, int]:
    """The size of a window that is no larger than the screen."""
    _, width, height = m.mlx_get_screen_size(display)
    return min(size[0], width), min(size[1], height)


def leave(status: int) -> NoReturn:
    """End the process without waiting for its threads."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
