"""PygletWindow: a window of pyglet; CanvasTexture and OverlayTriangles: what OpenGL 3.3 draws in it.

Create and use the last two while the window's OpenGL context is current.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Any

import pyglet.window
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram

from minirt.mlx.canvas import Canvas
from minirt.mlx.events import Cursor
from minirt.mlx.on_pyglet.x11 import is_x11

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
        super().__init__(width, height, **options)

    def dispatch_event(self, *event: Any) -> None:
        """Handle an event, then tell that it came."""
        super().dispatch_event(*event)
        self._changed()

    def set_wm_class(self, name: str) -> None:
        """Set X11's WM_CLASS, which pyglet derives from the first caption."""
        super().set_wm_class(self._application or name)


def new_cursor(window: PygletWindow, cursor: Cursor) -> Any:
    if cursor is Cursor.TURN and is_x11(window):
        from pyglet.libs.x11 import xlib
        from pyglet.window.xlib import XlibMouseCursor

        return XlibMouseCursor(xlib.XCreateFontCursor(window._x_display, EXCHANGE))
    return window.get_system_mouse_cursor(CURSORS[cursor])


class CanvasTexture:
    """A texture with the canvas's pixels.

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
        """Upload the changes of the canvas and blit it into the frame buffer of width by height pixels. The canvas then
        has no changes any more. If its size is a new one, all of it is uploaded."""
        gl.glActiveTexture(gl.GL_TEXTURE0)
        gl.glBindTexture(gl.GL_TEXTURE_2D, self._texture)
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self._framebuffer)
        changes = canvas.take_changes()
        if (canvas.width, canvas.height) != self._size:
            self._allocate(canvas.width, canvas.height)
            changes = 0, 0, canvas.width, canvas.height
        if changes is not None:  # upload the box straight from the canvas's memory, without a copy
            left, top, right, bottom = changes
            address = canvas.pixels[top:bottom, left:right].ctypes.data
            gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, canvas.width)
            gl.glTexSubImage2D(
                gl.GL_TEXTURE_2D, 0, left, top, right - left, bottom - top,
                gl.GL_BGRA, gl.GL_UNSIGNED_BYTE, ctypes.c_void_p(address),
            )  # fmt: skip
            gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 0)
        gl.glDisable(gl.GL_SCISSOR_TEST)
        gl.glBlitFramebuffer(
            0, 0, canvas.width, canvas.height,
            0, height, width, 0,  # upside down
            gl.GL_COLOR_BUFFER_BIT, gl.GL_NEAREST,
        )  # fmt: skip

    def _allocate(self, width: int, height: int) -> None:
        """Allocate the texture and attach it to the frame buffer that the blit reads."""
        gl.glTexImage2D(gl.GL_TEXTURE_2D, 0, gl.GL_RGBA, width, height, 0, gl.GL_BGRA, gl.GL_UNSIGNED_BYTE, None)
        for setting in (gl.GL_TEXTURE_MIN_FILTER, gl.GL_TEXTURE_MAG_FILTER):
            gl.glTexParameteri(gl.GL_TEXTURE_2D, setting, gl.GL_NEAREST)
        gl.glFramebufferTexture2D(gl.GL_READ_FRAMEBUFFER, gl.GL_COLOR_ATTACHMENT0, gl.GL_TEXTURE_2D, self._texture, 0)
        self._size = width, height


# Triangles of an overlay.

VERTEX, INDEX = 20, 2  # bytes
Run = tuple[int, tuple[float, float, float, float], int, int, int]  # see `Mlx.mlx_overlay_hook`
VERTEX_SHADER = """#version 330 core
uniform vec2 size;  // of the window, in pixels
layout(location = 0) in vec2 place;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
out vec2 texture_place;
out vec4 tint;
void main() {
    texture_place = uv;
    tint = colour;
    gl_Position = vec4(2.0 * place.x / size.x - 1.0, 1.0 - 2.0 * place.y / size.y, 0.0, 1.0);
}"""
FRAGMENT_SHADER = """#version 330 core
uniform sampler2D image;
in vec2 texture_place;
in vec4 tint;
out vec4 pixel;
void main() { pixel = tint * texture(image, texture_place); }"""
# Numbers, type, normalised, and offset in bytes of each attribute of a vertex.
ATTRIBUTES = (2, gl.GL_FLOAT, False, 0), (2, gl.GL_FLOAT, False, 8), (4, gl.GL_UNSIGNED_BYTE, True, 16)


class OverlayTriangles:
    """A shader program and buffers, for one window."""

    def __init__(self) -> None:
        self._program = ShaderProgram(Shader(VERTEX_SHADER, "vertex"), Shader(FRAGMENT_SHADER, "fragment"))
        self._array, self._vertices, self._indices = gl.GLuint(), gl.GLuint(), gl.GLuint()
        gl.glGenVertexArrays(1, ctypes.byref(self._array))
        gl.glGenBuffers(1, ctypes.byref(self._vertices))
        gl.glGenBuffers(1, ctypes.byref(self._indices))
        self.size = self.pixels = (1, 1)  # of the window in the coordinates of the overlay, and of its frame buffer

    def upload(self, texture: int, width: int, height: int, pixels: int) -> int:
        """Copy RGBA pixels from an address into a texture, 0 for a new one; return its number."""
        number = gl.GLuint(texture)
        if not texture:
            gl.glGenTextures(1, ctypes.byref(number))
        gl.glActiveTexture(gl.GL_TEXTURE0)
        gl.glBindTexture(gl.GL_TEXTURE_2D, number)
        for setting in (gl.GL_TEXTURE_MIN_FILTER, gl.GL_TEXTURE_MAG_FILTER):
            gl.glTexParameteri(gl.GL_TEXTURE_2D, setting, gl.GL_LINEAR)
        gl.glTexImage2D(
            gl.GL_TEXTURE_2D, 0, gl.GL_RGBA, width, height, 0, gl.GL_RGBA, gl.GL_UNSIGNED_BYTE, ctypes.c_void_p(pixels)
        )
        return int(number.value)

    def delete(self, texture: int) -> None:
        gl.glDeleteTextures(1, ctypes.byref(gl.GLuint(texture)))

    def draw(self, vertices: int, vertex_count: int, indices: int, index_count: int, runs: Sequence[Run]) -> None:
        """Blend triangles into the picture, in this order. `vertices` and `indices` are addresses in memory; for
        their formats and for `runs` see `Mlx.mlx_overlay_hook`."""
        self._program.use()
        self._program["size"] = self.size
        gl.glBindVertexArray(self._array)
        fill(gl.GL_ARRAY_BUFFER, self._vertices, vertices, vertex_count * VERTEX)
        fill(gl.GL_ELEMENT_ARRAY_BUFFER, self._indices, indices, index_count * INDEX)
        for location, (count, kind, normalised, offset) in enumerate(ATTRIBUTES):
            gl.glEnableVertexAttribArray(location)
            gl.glVertexAttribPointer(location, count, kind, normalised, VERTEX, offset)
        gl.glViewport(0, 0, *self.pixels)
        gl.glEnable(gl.GL_BLEND)
        gl.glBlendFunc(gl.GL_SRC_ALPHA, gl.GL_ONE_MINUS_SRC_ALPHA)
        gl.glEnable(gl.GL_SCISSOR_TEST)
        gl.glActiveTexture(gl.GL_TEXTURE0)
        # Pixels of the frame buffer in a pixel of the overlay.
        across, down = (pixels / size for pixels, size in zip(self.pixels, self.size, strict=True))
        for texture, (left, top, right, bottom), count, first_index, first_vertex in runs:
            x, y = round(left * across), self.pixels[1] - round(bottom * down)  # OpenGL counts from the bottom
            gl.glScissor(x, y, max(round(right * across) - x, 0), max(round((bottom - top) * down), 0))
            gl.glBindTexture(gl.GL_TEXTURE_2D, texture)
            start = ctypes.c_void_p(first_index * INDEX)
            gl.glDrawElementsBaseVertex(gl.GL_TRIANGLES, count, gl.GL_UNSIGNED_SHORT, start, first_vertex)
        gl.glDisable(gl.GL_SCISSOR_TEST)
        gl.glDisable(gl.GL_BLEND)


def fill(target: int, buffer: Any, address: int, size: int) -> None:
    """Copy memory into a buffer of OpenGL, and leave it bound."""
    gl.glBindBuffer(target, buffer)
    gl.glBufferData(target, size, ctypes.c_void_p(address), gl.GL_STREAM_DRAW)
