"""Wavefront .obj: text -> triangles.

A line is `v x y z`, a point; `vt u v`, a place in a picture; `vn x y z`, a normal; or `f` and three or more corners of
a face, each `v`, `v/vt`, `v//vn` or `v/vt/vn`: numbers of those lines, from 1, or from -1 backwards from where the face
stands. A face of more corners is a fan of triangles around its first. Groups, materials, lines and points are skipped.
"""

from __future__ import annotations

from io import BytesIO

import numpy as np

from minirt.meshes import diagnosing, fast
from minirt.meshes.block import Block, Counts, ObjError
from minirt.meshes.triangles import Triangles, non_degenerate, squared_lengths, unit

BLOCK_BYTES = 4 * 2**20  # bytes that are read at once
MAX_TRIANGLES = 10_000_000  # triangles

__all__ = ["ObjError", "parse"]


def parse(data: bytes) -> Triangles:
    """The triangles of a file, but for those that are no more than a line; BrokenError where it is not a mesh."""
    file, blocks = BytesIO(data.removeprefix(b"\xef\xbb\xbf")), []
    before, triangles = Counts(), 0
    while lines := file.readlines(BLOCK_BYTES):
        while lines[-1].endswith((b"\\\n", b"\\\r\n")) and (more := file.readline()):
            lines.append(more)
        block = fast.read(lines, before) or diagnosing.read(lines, before)
        blocks.append(block)
        before = before.behind(block, len(lines))
        triangles += int((block.sizes - 2).sum())
        if triangles > MAX_TRIANGLES:
            raise ObjError(f"has more than {MAX_TRIANGLES:,} triangles")
    return assemble(blocks)


def assemble(blocks: list[Block]) -> Triangles:
    """The triangles of the blocks of a file."""
    if not sum(len(block.sizes) for block in blocks):
        raise ObjError("has no faces")
    whole = Block(*map(np.concatenate, zip(*blocks, strict=True)))
    check_indices(whole)
    fans = whole.corners[fan_triangulation(whole.sizes)]
    corners = fans[..., 0]
    kept = non_degenerate(whole.points[corners])
    if not kept.any():
        raise ObjError("has no triangle that is more than a line")
    fans, corners = fans[kept], np.ascontiguousarray(corners[kept])
    uvs = None
    if (fans[..., 1] >= 0).any():
        uvs = np.where(fans[..., 1, None] >= 0, np.concatenate([whole.uvs, np.zeros((1, 2))])[fans[..., 1]], 0.0)
    flat = Triangles(whole.points, corners, None, uvs)
    if (fans[..., 2] < 0).all():
        return flat
    return Triangles(whole.points, corners, corner_normals(whole.normals, fans[..., 2], flat.flat_normals), uvs)


def corner_normals(normals: np.ndarray, which: np.ndarray, flat: np.ndarray) -> np.ndarray:
    """Unit normals at corners (m, 3), where there is none that of the triangle."""
    given = np.concatenate([normals, np.zeros((1, 3))])  # the last is that of index -1
    given[squared_lengths(given) > 0] = unit(given[squared_lengths(given) > 0])
    found = given[which]
    return np.where(squared_lengths(found)[..., None] > 0, found, flat[:, None])


def fan_triangulation(sizes: np.ndarray) -> np.ndarray:
    """Of faces with so many corners the places of the corners of their triangles, (m, 3)."""
    triangles = sizes - 2
    first = np.repeat(np.cumsum(sizes) - sizes, triangles)
    inside = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.stack([first, first + inside + 1, first + inside + 2], axis=1)


def check_indices(whole: Block) -> None:
    """BrokenError where a corner names something that the file does not have."""
    there = [len(whole.points), len(whole.uvs), len(whole.normals)]
    beyond = whole.corners >= there
    if beyond.any():
        corner = int(np.argmax(beyond.any(axis=1)))
        which = int(np.argmax(beyond[corner]))
        line = np.repeat(whole.lines, whole.sizes)[corner]
        raise ObjError(
            diagnosing.missing_index_message(which, int(whole.corners[corner, which]) + 1, there[which]), int(line)
        )
