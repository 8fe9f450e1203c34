"""PygletWindow: a window of pyglet with name, icon and pointer shapes; CanvasTexture: what it shows."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Any

import pyglet.window
from pyglet import gl

from minirt.mlx.arguments import Image
from minirt.mlx.canvas import Box, Canvas
from minirt.mlx.events import Cursor
from minirt.mlx.on_pyglet.x11 import is_x11, set_icon

CURSORS = {
    Cursor.ARROW: pyglet.window.Window.CURSOR_DEFAULT,
    Cursor.MOVE: pyglet.window.Window.CURSOR_SIZE,
    Cursor.TURN: pyglet.window.Window.CURSOR_CROSSHAIR,
    Cursor.GRAB: pyglet.window.Window.CURSOR_HAND,
}
EXCHANGE = 50  # X11's cursor of two curved arrows, which pyglet has no name for


class PygletWindow(pyglet.window.Window):  # type: ignore[misc]
    """`application`: the name by which window managers know the program, whatever the caption; "": the caption.

    `changed` is called after every event.
    """

    def __init__(self, changed: Callable[[], None], application: str, width: int, height: int, **options: Any) -> None:
        self._changed = changed
        self._application = application
        self._cursors: dict[Cursor, Any] = {}
        super().__init__(width, height, **options)

    def dispatch_event(self, *event: Any) -> None:
        """Handle an event, then tell that it came."""
        super().dispatch_event(*event)
        self._changed()

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


class CanvasTexture:
    """A texture with the canvas's pixels. Create and draw it while the window's OpenGL context is current.

    The texture is blitted, not drawn: with software rendering that is one copy of memory, which takes a third of the
    time of a triangle filled by a shader. It stays a plain copy as long as the texture has the canvas's format (BGRA)
    and the blit flips the rows: they run down in the canvas and up in OpenGL, and software renderers store the frame
    buffer downwards, which is a second flip.
    """

    def __init__(self) -> None:
        self._texture, self._framebuffer = gl.GLuint(), gl.GLuint()
        gl.glGenTextures(1, ctypes.byref(self._texture))
        gl.glGenFramebuffers(1, ctypes.byref(self._framebuffer))
        self._size = (0, 0)

    def draw(self, canvas: Canvas, width: int, height: int) -> None:
        """Upload the changes of the canvas and blit it into the frame buffer of width by height pixels."""
        gl.glActiveTexture(gl.GL_TEXTURE0)
        gl.glBindTexture(gl.GL_TEXTURE_2D, self._texture)
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self._framebuffer)
        changes = canvas.take_changes()
        if (canvas.width, canvas.height) != self._size:
            self._allocate(canvas.width, canvas.height)
            changes = 0, 0, canvas.width, canvas.height
        if changes is not None:
            _upload(canvas, changes)
        gl.glDisable(gl.GL_SCISSOR_TEST)
        gl.glBlitFramebuffer(
            0, 0, canvas.width, canvas.height, 0, height, width, 0, gl.GL_COLOR_BUFFER_BIT, gl.GL_NEAREST
        )  # fmt: skip

    def _allocate(self, width: int, height: int) -> None:
        """Allocate the texture and attach it to the frame buffer that the blit reads."""
        gl.glTexImage2D(
            gl.GL_TEXTURE_2D, 0, gl.GL_RGBA, width, height, 0, gl.GL_BGRA, gl.GL_UNSIGNED_BYTE, None
        )  # fmt: skip
        for setting in (gl.GL_TEXTURE_MIN_FILTER, gl.GL_TEXTURE_MAG_FILTER):
            gl.glTexParameteri(gl.GL_TEXTURE_2D, setting, gl.GL_NEAREST)
        gl.glFramebufferTexture2D(
            gl.GL_READ_FRAMEBUFFER, gl.GL_COLOR_ATTACHMENT0, gl.GL_TEXTURE_2D, self._texture, 0
        )  # fmt: skip
        self._size = width, height


def _upload(canvas: Canvas, box: Box) -> None:
    """Upload a box of the canvas straight from its memory, without a copy."""
    left, top, right, bottom = box
    address = canvas.pixels[top:bottom, left:right].ctypes.data
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, canvas.width)
    gl.glTexSubImage2D(
        gl.GL_TEXTURE_2D, 0, left, top, right - left, bottom - top,
        gl.GL_BGRA, gl.GL_UNSIGNED_BYTE, ctypes.c_void_p(address),
    )  # fmt: skip
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 0)
