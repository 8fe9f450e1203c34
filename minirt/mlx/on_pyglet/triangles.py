"""Triangles: draw an overlay by OpenGL 3.3. Create and use it while the window's OpenGL context is current."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram

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
ATTRIBUTES = (  # numbers, type, normalised, and offset in bytes
    (2, gl.GL_FLOAT, False, 0),
    (2, gl.GL_FLOAT, False, 8),
    (4, gl.GL_UNSIGNED_BYTE, True, 16),
)


class Triangles:
    """A shader program and buffers, for one window."""

    def __init__(self) -> None:
        self._program = ShaderProgram(Shader(VERTEX_SHADER, "vertex"), Shader(FRAGMENT_SHADER, "fragment"))
        self._array, self._vertices, self._indices = gl.GLuint(), gl.GLuint(), gl.GLuint()
        gl.glGenVertexArrays(1, ctypes.byref(self._array))
        gl.glGenBuffers(1, ctypes.byref(self._vertices))
        gl.glGenBuffers(1, ctypes.byref(self._indices))
        self._size = self._pixels = (1, 1)

    def resize(self, size: tuple[int, int], pixels: tuple[int, int]) -> None:
        """Set the size of the window in the coordinates of the overlay, and that of its frame buffer."""
        self._size, self._pixels = size, pixels

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
        """Free a texture."""
        gl.glDeleteTextures(1, ctypes.byref(gl.GLuint(texture)))

    def draw(self, vertices: int, vertex_count: int, indices: int, index_count: int, runs: Sequence[Run]) -> None:
        """Blend triangles into the picture, in this order, from the addresses of their vertices and indices."""
        self._program.use()
        self._program["size"] = self._size
        gl.glBindVertexArray(self._array)
        fill(gl.GL_ARRAY_BUFFER, self._vertices, vertices, vertex_count * VERTEX)
        fill(gl.GL_ELEMENT_ARRAY_BUFFER, self._indices, indices, index_count * INDEX)
        for place, (count, kind, normalised, offset) in enumerate(ATTRIBUTES):
            gl.glEnableVertexAttribArray(place)
            gl.glVertexAttribPointer(place, count, kind, normalised, VERTEX, offset)
        gl.glViewport(0, 0, *self._pixels)
        gl.glEnable(gl.GL_BLEND)
        gl.glBlendFunc(gl.GL_SRC_ALPHA, gl.GL_ONE_MINUS_SRC_ALPHA)
        gl.glEnable(gl.GL_SCISSOR_TEST)
        gl.glActiveTexture(gl.GL_TEXTURE0)
        for texture, box, count, first_index, first_vertex in runs:
            self._clip(*box)
            gl.glBindTexture(gl.GL_TEXTURE_2D, texture)
            start = ctypes.c_void_p(first_index * INDEX)
            gl.glDrawElementsBaseVertex(gl.GL_TRIANGLES, count, gl.GL_UNSIGNED_SHORT, start, first_vertex)
        gl.glDisable(gl.GL_SCISSOR_TEST)
        gl.glDisable(gl.GL_BLEND)

    def _clip(self, left: float, top: float, right: float, bottom: float) -> None:
        """Draw nothing outside of a rectangle, which OpenGL counts from the bottom, in pixels of the frame buffer."""
        across, down = (pixels / size for pixels, size in zip(self._pixels, self._size, strict=True))
        x, y = round(left * across), self._pixels[1] - round(bottom * down)
        gl.glScissor(x, y, max(round(right * across) - x, 0), max(round((bottom - top) * down), 0))


def fill(target: int, buffer: Any, address: int, size: int) -> None:
    """Copy memory into a buffer of OpenGL, and leave it bound."""
    gl.glBindBuffer(target, buffer)
    gl.glBufferData(target, size, ctypes.c_void_p(address), gl.GL_STREAM_DRAW)
