"""The viewer in notebooks: a widget that shows the pictures of a session and sends keys and mouse back.

`view` chooses between the widget and a window. The widget needs anywidget, which the extra `minirt[notebook]` installs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypedDict, Unpack, overload

from minirt.errors import MlxError
from minirt.helpers.progress import in_notebook

if TYPE_CHECKING:
    from minirt.mlx import Mlx
    from minirt.notebook.widget import Viewer
    from minirt.scene import Scene

    class Settings(TypedDict, total=False):
        """Arguments of `view` that do not choose its result."""

        samples: int
        threads: int | None
        precision: Literal["double", "single"]
        keys: str
        mlx: Mlx | None
        dither: bool


INSTALL = "a viewer in a notebook needs anywidget: pip install 'minirt[notebook]'"


@overload
def view(
    scene: Scene, size: tuple[int, int] | None = None, *, notebook: Literal[True], **settings: Unpack[Settings]
) -> Viewer: ...


@overload
def view(
    scene: Scene, size: tuple[int, int] | None = None, *, notebook: Literal[False], **settings: Unpack[Settings]
) -> Scene: ...


@overload
def view(
    scene: Scene, size: tuple[int, int] | None = None, *, notebook: bool | None = None, **settings: Unpack[Settings]
) -> Scene | Any: ...


def view(
    scene: Scene,
    size: tuple[int, int] | None = None,
    *,
    notebook: bool | None = None,
    samples: int = 16,
    threads: int | None = None,
    precision: Literal["double", "single"] = "double",
    keys: str = "auto",
    mlx: Mlx | None = None,
    dither: bool = False,
) -> Scene | Viewer:
    """Show a scene in a window until it is closed, and return the scene as it was edited there.

    With `notebook=True`, and in a notebook without a display, return a `Viewer` at once: the last value of a cell is
    shown below it, and takes the keys and the mouse of the window. `.scene` of it is the scene as edited so far.

    Ctrl+S writes the file that the scene was read from, or `scene.rt`. `size` is that of the window in pixels;
    `samples`, the most rays per pixel of a picture at rest. `keys` is the layout of the keyboard: auto, qwerty, azerty
    or qwertz. The other arguments are those of `minirt.render`. MlxError where neither can be opened.
    """
    from minirt.scene.scene import check_scene
    from minirt.viewer import view as view_in_window

    check_scene(scene, "view")
    if not notebook:
        try:
            return view_in_window(
                scene, size, samples=samples, threads=threads, precision=precision, keys=keys, mlx=mlx, dither=dither
            )
        except MlxError:
            if notebook is False or not in_notebook():
                raise
    try:
        from minirt.notebook.widget import Viewer
    except ImportError as error:
        raise MlxError(f"{INSTALL} ({error})") from None
    return Viewer(scene, size, samples=samples, threads=threads, precision=precision, keys=keys, dither=dither)
