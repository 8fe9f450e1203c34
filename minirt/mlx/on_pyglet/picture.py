"""A canvas on the screen: a texture, copied into the window's framebuffer."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from pyglet import gl

if TYPE_CHECKING:
    from minirt.mlx.canvas import Box, Canvas


class Picture:
    """To be made and drawn while the window's context is the current one.

    The texture takes the canvas as it is, and is blitted, not drawn: where graphics are software's work that is one
    copy of memory, a third of the time of a triangle that a shader fills. It stays one as long as no format is asked
    for but the canvas's own, blue first, and rows are turned over twice: they go down in the canvas and up on the
    screen, which software keeps downwards.
    """

    def __init__(self) -> None:
        self._texture, self._source = gl.GLuint(), gl.GLuint()
        gl.glGenTextures(1, ctypes.byref(self._texture))
        gl.glGenFramebuffers(1, ctypes.byref(self._source))
        self._size = (0, 0)

    def draw(self, canvas: Canvas, width: int, height: int) -> None:
        """Bring what changed to the graphics card and fill the framebuffer, which is width by height pixels."""
        gl.glActiveTexture(gl.GL_TEXTURE0)
        gl.glBindTexture(gl.GL_TEXTURE_2D, self._texture)
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self._source)
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
    """Straight from the canvas's memory, without a copy."""
    left, top, right, bottom = box
    address = canvas.pixels[top:bottom, left:right].ctypes.data
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, canvas.width)
    gl.glTexSubImage2D(
        gl.GL_TEXTURE_2D, 0, left, top, right - left, bottom - top,
        gl.GL_BGRA, gl.GL_UNSIGNED_BYTE, ctypes.c_void_p(address),
    )  # fmt: skip
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 0)
