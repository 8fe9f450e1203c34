"""Data of a block of lines of an .obj file, as arrays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class ObjError(Exception):
    """A file that is not a mesh; the message names the line, unless it is about the whole file."""

    def __init__(self, message: str, line: int = 0) -> None:
        super().__init__(f"line {line}: {message}" if line else message)


class Block(NamedTuple):
    """Vertices, corners and faces of a block of lines, or of a whole file."""

    points: np.ndarray  # (n, 3) vertex positions
    uvs: np.ndarray  # (k, 2) texture coordinates
    normals: np.ndarray  # (j, 3) of any length
    corners: np.ndarray  # (c, 3) for each corner of all faces the index of its point, uv and normal, or -1
    sizes: np.ndarray  # (f,) number of corners of each face
    lines: np.ndarray  # (f,) line of each face, from 1


class Counts(NamedTuple):
    """Numbers of points, uvs, normals and lines of a file before a block."""

    points: int = 0
    uvs: int = 0
    normals: int = 0
    lines: int = 0

    def after(self, block: Block, lines: int) -> Counts:
        """Return the counts after a block of that many lines."""
        points, uvs, normals = (before + len(new) for before, new in zip(self[:3], block[:3], strict=True))
        return Counts(points, uvs, normals, self.lines + lines)
