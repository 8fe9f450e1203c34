"""CanvasTexture: a canvas as an OpenGL texture, blitted into the frame buffer of a window."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from pyglet import gl

if TYPE_CHECKING:
    from minirt.mlx.canvas import Box, Canvas


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
