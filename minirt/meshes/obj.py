"""Parser of Wavefront .obj files: text -> triangles.

A line is `v x y z`, a point; `vt u v`, texture coordinates; `vn x y z`, a normal; or `f` and three or more corners of
a face, each `v`, `v/vt`, `v//vn` or `v/vt/vn`. These are numbers of such lines, counted from 1, or backwards from -1,
the last one before the face. Groups, materials, lines and points are skipped.
Polygons are cut into triangles, see `minirt.meshes.polygons`.
"""

from __future__ import annotations

from io import BytesIO

import numpy as np

from minirt.meshes import obj_lines
from minirt.meshes.obj_lines import Block, ObjError
from minirt.meshes.polygons import triangulate
from minirt.meshes.triangles import Triangles, non_degenerate, squared_lengths, unit

BLOCK_BYTES = 2**20  # of lines that are parsed at once; their words take up to a hundred times as much
LONGEST_LINE = 2**24  # bytes, with the lines that continue it
MAX_TRIANGLES = 10_000_000
MAX_LINES = 2**24  # of 16 bytes fill the largest file


def parse(data: bytes) -> Triangles:
    """Parse a file; degenerate triangles are dropped. ObjError when it is not a mesh."""
    if (lines_in_all := data.count(b"\n")) > MAX_LINES:
        raise ObjError(f"has {lines_in_all:,} lines, more than {MAX_LINES:,}")
    data = data.removeprefix(b"\xef\xbb\xbf")
    file, blocks = BytesIO(data), []
    first, before, triangles = 1, [0, 0, 0], 0
    while lines := read_lines(file, first):
        block = obj_lines.read(lines, first, before)
        blocks.append(block)
        first += len(lines)
        before = [count + len(new) for count, new in zip(before, block[:3], strict=True)]
        triangles += int((block.sizes - 2).sum())
        if triangles > MAX_TRIANGLES:
            raise ObjError(f"has more than {MAX_TRIANGLES:,} triangles")
    return assemble(blocks, data)


def read_lines(file: BytesIO, first: int) -> list[bytes]:
    """Return the next lines of a file, from number `first`, about `BLOCK_BYTES`, and what continues them; ObjError."""
    lines = file.readlines(BLOCK_BYTES)
    size = len(lines[-1]) if lines else 0
    while size <= LONGEST_LINE and lines and lines[-1].endswith((b"\\\n", b"\\\r\n")) and (more := file.readline()):
        lines.append(more)
        size += len(more)
    if size > LONGEST_LINE:
        raise ObjError(f"longer than {LONGEST_LINE // 2**20} MiB", first + len(lines) - 1)
    return lines


def assemble(blocks: list[Block], data: bytes) -> Triangles:
    """Assemble the blocks of a file into triangles; ObjError."""
    if not sum(len(block.sizes) for block in blocks):
        raise ObjError("has no faces")
    whole = Block(*map(np.concatenate, zip(*blocks, strict=True)))
    check_indices(whole, data)
    fans = whole.corners[triangulate(whole.points, whole.corners[:, 0], whole.sizes, whole.lines)]
    corners = fans[..., 0]
    valid = non_degenerate(whole.points[corners])
    if not valid.any():
        raise ObjError("has no triangle that is more than a line")
    fans, corners = fans[valid], np.ascontiguousarray(corners[valid])
    uvs = None
    if (fans[..., 1] >= 0).any():
        uvs = np.where(fans[..., 1, None] >= 0, np.concatenate([whole.uvs, np.zeros((1, 2))])[fans[..., 1]], 0.0)
    flat = Triangles(whole.points, corners, None, uvs)
    if (fans[..., 2] < 0).all():
        return flat
    return Triangles(whole.points, corners, corner_normals(whole.normals, fans[..., 2], flat.flat_normals), uvs)


def corner_normals(normals: np.ndarray, indices: np.ndarray, flat: np.ndarray) -> np.ndarray:
    """Return unit normals at corners, (m, 3, 3); a corner without one, index -1 or of length 0, has the flat normal."""
    padded = np.concatenate([normals, np.zeros((1, 3))])  # the last is that of index -1
    padded[squared_lengths(padded) > 0] = unit(padded[squared_lengths(padded) > 0])
    chosen = padded[indices]
    return np.where(squared_lengths(chosen)[..., None] > 0, chosen, flat[:, None])


def check_indices(whole: Block, data: bytes) -> None:
    """Check that the file has all items that its corners name; ObjError otherwise."""
    counts = [len(whole.points), len(whole.uvs), len(whole.normals)]
    beyond = whole.corners >= counts
    if beyond.any():
        corner = int(np.argmax(beyond.any(axis=1)))
        part = int(np.argmax(beyond[corner]))
        face = int(np.searchsorted(np.cumsum(whole.sizes), corner, side="right"))
        line, number = int(whole.lines[face]), corner - int(whole.sizes[:face].sum())
        words = obj_lines.words_of(obj_lines.plain_lines(BytesIO(data).readlines())[line - 1])
        raise ObjError(obj_lines.missing_index_message(part, counts[part]), line, words[1 + number].start() + 1)
