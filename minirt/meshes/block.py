"""What some lines of an .obj file hold."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class ObjError(Exception):
    """What is wrong with a file, and in which line."""

    def __init__(self, message: str, line: int = 0) -> None:
        super().__init__(f"line {line}: {message}" if line else message)


class Block(NamedTuple):
    """Points, corners and faces of some lines, or of all."""

    points: np.ndarray  # (n, 3)
    uvs: np.ndarray  # (k, 2)
    normals: np.ndarray  # (j, 3) of any length
    corners: np.ndarray  # (c, 3) of all faces: index of the point, of the place in the picture, of the normal, or -1
    sizes: np.ndarray  # (f,) corners of each face
    lines: np.ndarray  # (f,) line of each, from 1


class Counts(NamedTuple):
    """How much of a file there is before a line."""

    points: int = 0
    uvs: int = 0
    normals: int = 0
    lines: int = 0

    def behind(self, block: Block, lines: int) -> Counts:
        """The same behind a block of so many lines."""
        points, uvs, normals = (before + len(new) for before, new in zip(self[:3], block[:3], strict=True))
        return Counts(points, uvs, normals, self.lines + lines)
