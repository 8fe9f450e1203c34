"""The viewer in notebooks: a widget that shows the pictures of a session and sends keys and mouse back.

`view` chooses between the widget and a window. The widget needs anywidget, which the extra `minirt[notebook]` installs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Unpack, overload

from minirt.errors import MlxError
from minirt.helpers.progress import in_notebook
from minirt.mlx import Mlx
from minirt.rendering.settings import takes_settings
from minirt.scene import Scene, check_scene
from minirt.viewer.app import desktop
from minirt.viewer.app.desktop import ViewSettings

if TYPE_CHECKING:
    from minirt.notebook.widget import Viewer

INSTALL = "a viewer in a notebook needs anywidget: pip install 'minirt[notebook]'"
Size = tuple[int, int] | None


@overload
def view(
    scene: Scene, size: Size = None, *, notebook: Literal[True], mlx: Mlx | None = None,
    **settings: Unpack[ViewSettings],
) -> Viewer: ...  # fmt: skip


@overload
def view(
    scene: Scene, size: Size = None, *, notebook: bool | None = None, mlx: Mlx | None = None,
    **settings: Unpack[ViewSettings],
) -> Scene | Any: ...  # fmt: skip


def view(
    scene: Scene,
    size: Size = None,
    *,
    notebook: bool | None = None,
    mlx: Mlx | None = None,
    **settings: Unpack[ViewSettings],
) -> Scene | Viewer:
    """Show a scene in a window until it is closed, and return the scene as it was edited there.

    With `notebook=True`, and in a notebook without a display unless `notebook` is False, return a `Viewer` at once. A
    Viewer that is the last value of a cell is shown below the cell, and takes keys and mouse as the window does. Its
    `scene` is the scene as edited so far.

    Ctrl+S writes the file that the scene was read from, or `scene.rt`. `size` is that of the window in pixels; `mlx`
    opens the window, not the Viewer. The settings: `samples`, the most rays per pixel of a picture at rest, 16; `keys`,
    the layout of the keyboard: auto, qwerty, azerty or qwertz; `threads`, `precision` and `dither` as of
    `minirt.render`. MlxError if neither can be opened, KeyboardInterrupt if Ctrl+C ends the window.
    """
    check_scene(scene, "view")
    if not notebook:
        try:
            session = desktop.open_view(scene, size, mlx or Mlx(), **settings)
            status, _ = desktop.run_event_loop(session)
            if status == desktop.INTERRUPTED:
                raise KeyboardInterrupt
            return session.state.scene
        except MlxError as error:
            if notebook is False or not in_notebook():
                error.add_note('minirt.render(scene, 640, 480).save("picture.png") needs no window')
                raise
    try:
        from minirt.notebook.widget import Viewer
    except ImportError as error:
        raise MlxError(f"{INSTALL} ({error})") from None
    return Viewer(scene, size, **settings)


takes_settings(view, desktop.open_view)
