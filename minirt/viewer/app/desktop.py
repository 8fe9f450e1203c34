"""The viewer as a program: open the window, run the event loop, end."""

from __future__ import annotations

import os
import sys
import zlib
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal, TypedDict

import numpy as np

from minirt.errors import printable
from minirt.helpers import package
from minirt.helpers.signals import ended_by_signals, held_signals, leave
from minirt.helpers.system import gc_paused
from minirt.mlx import Mlx, MlxImage
from minirt.rendering.renderer import Renderer
from minirt.rendering.renderer import renderer as shared_renderer
from minirt.scene import Scene, size_of
from minirt.viewer.app.commands import offer_found, tell_dialect, tell_new
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.app.session import Session
from minirt.viewer.display.painter import BackgroundPainter
from minirt.viewer.files import contents_differ, save_recovery
from minirt.viewer.recovery import Recovery, panel_was_open


class ViewSettings(TypedDict, total=False):
    """Settings of `open_view` and `minirt.view`."""

    samples: int
    threads: int | None
    precision: Literal["double", "single"]
    keys: str
    dither: bool


OK, INTERRUPTED = 0, 130
STOP_TIMEOUT = 0.3  # seconds that a picture being rendered has to notice that it is cancelled
SWITCH_INTERVAL = 0.0005  # seconds that another thread may keep the interpreter: a tenth of the default


def run(
    scene: Scene,
    *,
    path: str | os.PathLike[str],
    renderer: Renderer,
    size: tuple[int, int] | None = None,
    text_scale: float = 1.0,
    mlx: Mlx | None = None,
    **options: Any,
) -> int:
    """Show a scene until the user quits; return the exit status: 0, or 128 + n after signal n (Ctrl+C: 130).

    `path` is the scene's file. Unsaved changes are kept in a recovery file, whose name is printed; those of a program
    that was killed are offered at the next start. `text_scale`: a factor for the size of text and icons; `options`:
    those of `Session`.

    MlxError if no window can be opened, RenderError if the pictures cannot be rendered.

    If the renderer cannot be stopped (inside the compiler), the process ends here at once.
    """
    session = open_session(scene, Path(path), size, renderer, mlx or Mlx(), **options)
    session.screen.text_scale = text_scale
    session.recovery = Recovery()
    session.wants_panel = panel_was_open()
    tell_new(session)
    offer_found(session)
    tell_dialect(session)
    session.mlx.mlx_lost_hook(session.display, lose_window, session)
    try:
        status, stopped = run_event_loop(session)
    finally:
        with held_signals():
            end_recovery(session)
    if not stopped:
        leave(status)
    return status


def open_view(
    scene: Scene,
    size: tuple[int, int] | None,
    mlx: Mlx,
    *,
    samples: int = 16,
    threads: int | None = None,
    precision: Literal["double", "single"] = "double",
    keys: str = "auto",
    dither: bool = False,
) -> Session:
    """Open the session of `minirt.view`, whose Ctrl+S writes the file that the scene was read from, or `scene.rt`. The
    parameters are those of `minirt.view`. MlxError if no window can be opened."""
    renderer = shared_renderer(threads, precision, dither=dither)
    return open_session(scene, scene.file or Path("scene.rt"), size, renderer, mlx, keys=keys, samples=samples)


def open_session(
    scene: Scene, path: Path, size: tuple[int, int] | None, renderer: Renderer, mlx: Mlx, **options: Any
) -> Session:
    """Open a session with its window, connected to the window's events; `options` are those of `Session`.

    size: of the window in pixels, cut to that of the screen; None for the scene's. After an error, which is MlxError if
    no window can be opened, the display is closed.
    """
    mlx.mlx_set_options(strict=True)
    display = mlx.mlx_init()
    try:
        with gc_paused():
            _, *screen = mlx.mlx_get_screen_size(display)
            wanted = size or size_of(scene)
            fitting = min(wanted[0], screen[0]), min(wanted[1], screen[1])
            session = Session(mlx, display, scene, path, fitting, renderer, BackgroundPainter, **options)
            EventDispatcher(session)  # which becomes the hooks of the window
            session.screen.tips = session.screen.handles = True
            mlx.mlx_set_window_icon(session.window, application_icons())
            return session
    except BaseException:
        mlx.mlx_release(display)
        raise


def application_icons() -> list[MlxImage]:
    """Return the icon in three sizes: a ball that reflects a checkered floor, as this program has traced it.

    They lie in one PNG file of one chunk of rows without filters, which needs no decoder, whose import takes 60 ms.
    """
    rows = zlib.decompress(package.read(__name__, "icons.png")[41:-16])
    sheet = np.frombuffer(rows, np.uint8).reshape(64, -1)[:, 1:].reshape(64, -1, 4)[..., [2, 1, 0, 3]]
    return [MlxImage(sheet[:size, left : left + size].copy()) for size, left in ((16, 96), (32, 64), (64, 0))]


def run_event_loop(session: Session) -> tuple[int, bool]:
    """Run the event loop until it ends, then close window and threads; return the exit status, and whether all threads
    have ended.

    The status is OK, or that of the first signal: 128 + its number. RenderError for an error that nobody expected.
    """
    statuses = []

    def end(number: int) -> None:
        statuses.append(128 + number)
        if len(statuses) > 1:  # the first signal did not end the loop, because a hook does not return
            raise KeyboardInterrupt
        session.quit()
        session.mlx.mlx_wake(session.display)

    before = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH_INTERVAL)
    try:
        with ended_by_signals(end):
            session.mlx.mlx_loop(session.display)
    except KeyboardInterrupt:
        statuses.append(INTERRUPTED)
    finally:
        sys.setswitchinterval(before)
        session.mlx.mlx_release(session.display)
        session.file.close()
        stopped = session.refinement.painter.close(STOP_TIMEOUT)
    if session.defect:
        raise session.defect
    return statuses[0] if statuses else OK, stopped


def end_recovery(session: Session) -> None:
    """Write unsaved changes to a file beside the scene, and say so. Where that fails they stay kept: FileError."""
    saved = False
    try:
        if contents_differ(session.state.scene, session.saved):
            copy = save_recovery(session.state.scene, session.path)
            with suppress(OSError):  # standard output may be closed
                print(f"The changes that were not saved are in {printable(str(copy))}", flush=True)
        saved = True
    finally:
        if session.recovery:
            session.recovery.close(delete=saved)


def lose_window(session: Session) -> None:
    """Write unsaved changes because the display has gone; errors end nothing."""
    with suppress(Exception):
        end_recovery(session)
