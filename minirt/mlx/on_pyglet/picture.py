"""A canvas on the screen: one texture that fills the window, with OpenGL 3.3."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram

if TYPE_CHECKING:
    from minirt.mlx.canvas import Box, Canvas

# One triangle that covers the window, and more. Rows go down in the canvas and up on the screen.
VERTEX = """#version 330 core
out vec2 at;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
    at = vec2(2.0 * corner.x, 1.0 - 2.0 * corner.y);
}
"""

# The canvas has blue first. Whole numbers (texelFetch) would stretch to the same pixels on every driver, but divide for
# each pixel: 1.7 times the time in software.
FRAGMENT = """#version 330 core
in vec2 at;
uniform sampler2D canvas;
out vec4 color;
void main() {
    color = vec4(texture(canvas, at).bgr, 1.0);
}
"""


class Picture:
    """To be made and drawn while the window's context is the current one."""

    def __init__(self) -> None:
        self._program = ShaderProgram(Shader(VERTEX, "vertex"), Shader(FRAGMENT, "fragment"))
        self._vertices = gl.GLuint()
        gl.glGenVertexArrays(1, ctypes.byref(self._vertices))
        self._texture = gl.GLuint()
        gl.glGenTextures(1, ctypes.byref(self._texture))
        self._size = (0, 0)

    def draw(self, canvas: Canvas, width: int, height: int) -> None:
        """Bring what changed to the graphics card and fill the framebuffer, which is width by height pixels."""
        gl.glActiveTexture(gl.GL_TEXTURE0)
        gl.glBindTexture(gl.GL_TEXTURE_2D, self._texture)
        changes = canvas.take_changes()
        if (canvas.width, canvas.height) != self._size:
            self._allocate(canvas.width, canvas.height)
            changes = 0, 0, canvas.width, canvas.height
        if changes is not None:
            _upload(canvas, changes)
        self._program.use()
        gl.glBindVertexArray(self._vertices)
        gl.glDisable(gl.GL_BLEND)
        gl.glViewport(0, 0, width, height)
        gl.glDrawArrays(gl.GL_TRIANGLES, 0, 3)

    def _allocate(self, width: int, height: int) -> None:
        gl.glTexImage2D(
            gl.GL_TEXTURE_2D, 0, gl.GL_RGBA8, width, height, 0, gl.GL_RGBA, gl.GL_UNSIGNED_BYTE, None
        )  # fmt: skip
        for setting in (gl.GL_TEXTURE_MIN_FILTER, gl.GL_TEXTURE_MAG_FILTER):
            gl.glTexParameteri(gl.GL_TEXTURE_2D, setting, gl.GL_NEAREST)
        self._size = width, height


def _upload(canvas: Canvas, box: Box) -> None:
    """Straight from the canvas's memory, without a copy."""
    left, top, right, bottom = box
    address = canvas.pixels[top:bottom, left:right].ctypes.data
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, canvas.width)
    gl.glTexSubImage2D(
        gl.GL_TEXTURE_2D, 0, left, top, right - left, bottom - top,
        gl.GL_RGBA, gl.GL_UNSIGNED_BYTE, ctypes.c_void_p(address),
    )  # fmt: skip
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 0)
