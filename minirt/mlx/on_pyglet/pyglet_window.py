"""PygletWindow: a window of pyglet with the name and icon of its application, and with shapes of the pointer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyglet.window

from minirt.mlx.cursors import Cursor
from minirt.mlx.on_pyglet.x11_properties import is_x11, set_icon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from minirt.mlx.image import Image

CURSORS = {
    Cursor.ARROW: pyglet.window.Window.CURSOR_DEFAULT,
    Cursor.MOVE: pyglet.window.Window.CURSOR_SIZE,
    Cursor.TURN: pyglet.window.Window.CURSOR_CROSSHAIR,
    Cursor.GRAB: pyglet.window.Window.CURSOR_HAND,
}
EXCHANGE = 50  # X11's cursor of two curved arrows, which pyglet has no name for


class PygletWindow(pyglet.window.Window):  # type: ignore[misc]
    """`application`: the name by which window managers know the program, whatever the caption; "": the caption."""

    def __init__(self, application: str, width: int, height: int, **options: Any) -> None:
        self._application = application
        self._cursors: dict[Cursor, Any] = {}
        super().__init__(width, height, **options)

    def set_wm_class(self, name: str) -> None:
        """Set X11's WM_CLASS, which pyglet derives from the first caption."""
        super().set_wm_class(self._application or name)

    def set_icons(self, images: Sequence[Image]) -> None:
        """Set the icon of the window, in several sizes."""
        if images and is_x11(self):  # pyglet takes a tenth of a second for it
            set_icon(self, [image.pixels for image in images])
        elif images:
            pictures = [
                pyglet.image.ImageData(each.width, each.height, "BGRA", each.pixels.tobytes(), pitch=-4 * each.width)
                for each in images
            ]
            self.set_icon(*pictures)

    def set_cursor(self, cursor: Cursor) -> None:
        """Give the pointer a shape."""
        if cursor not in self._cursors:
            self._cursors[cursor] = self._new_cursor(cursor)
        self.set_mouse_cursor(self._cursors[cursor])

    def _new_cursor(self, cursor: Cursor) -> Any:
        if cursor is Cursor.TURN and is_x11(self):
            from pyglet.libs.x11 import xlib
            from pyglet.window.xlib import XlibMouseCursor

            return XlibMouseCursor(xlib.XCreateFontCursor(self._x_display, EXCHANGE))
        return self.get_system_mouse_cursor(CURSORS[cursor])
