"""Parser of Wavefront .obj files: text -> triangles.

A line is `v x y z`, a point; `vt u v`, texture coordinates; `vn x y z`, a normal; or `f` and three or more corners of
a face, each `v`, `v/vt`, `v//vn` or `v/vt/vn`. These are numbers of such lines, counted from 1, or backwards from -1,
the last one before the face; a corner whose vt or vn is not there is as one without. `v x y z r g b` has a colour, in
[0, 1]. The faces after `usemtl name` have that material of the files named by `mtllib`. Groups, lines and points are
skipped without a word, unknown words with a notice, and so are points with a coordinate `nan` or `inf` that no face
names. Polygons are cut into triangles, see `minirt.meshes.polygons`.
"""

from __future__ import annotations

from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from minirt.meshes import obj_lines
from minirt.meshes.obj_bytes import ABSENT, NOWHERE
from minirt.meshes.obj_lines import Block, ObjError, line_of
from minirt.meshes.polygons import triangulate
from minirt.meshes.triangles import Triangles, non_degenerate, squared_lengths, unit, used_points

BLOCK_BYTES = 2**20  # of lines that are parsed at once; their words take up to a hundred times as much
LONGEST_LINE = 2**24  # bytes, with the lines that continue it
MAX_TRIANGLES = 10_000_000
MAX_LINES = 2**24  # of 16 bytes fill the largest file
BEGINNING = 64  # bytes, by which UTF-16 is known
TINY = 1e-75  # of the coordinates of a triangle: the square of its area is 0
NOT_FINITE = "has points that no face names with a coordinate that is no number: they are skipped"


def parse(data: bytes, folder: Path | None = None) -> Triangles:
    """Return the triangles of the bytes of a file, without degenerate ones; ObjError when it is not a mesh.

    Materials are read beside the file, in `folder`; without one there are none.
    """
    check_lines(data)
    if is_utf16(data[:BEGINNING]):
        raise ObjError("is UTF-16: save it as UTF-8")
    data, blocks = data.removeprefix(b"\xef\xbb\xbf"), []
    start, before, triangles = 0, [0, 0, 0], 0  # `before`: points, uvs and normals of the blocks so far
    while start < len(data):
        end = end_of_block(data, start)
        block = obj_lines.read(data, start, end, before)
        blocks.append(block)
        start, before = end, [count + len(new) for count, new in zip(before, block[:3], strict=True)]
        triangles += int((block.sizes - 2).sum())
        check_triangles(triangles)
    return assemble(blocks, data, folder)


def is_utf16(data: bytes) -> bool:
    """Whether a file that begins with these bytes is UTF-16: by its mark, or since every other byte is 0."""
    return data.startswith((BOM_UTF16_LE, BOM_UTF16_BE)) or (len(data) > 1 and any(data[::2]) != any(data[1::2]))


def check_lines(data: bytes) -> None:
    """Check how many lines a file has; ObjError."""
    if (lines := data.count(b"\n")) > MAX_LINES:
        raise ObjError(f"has {lines:,} lines, more than {MAX_LINES:,}")


def check_triangles(count: int) -> None:
    """Check how many triangles a mesh has; ObjError."""
    if count > MAX_TRIANGLES:
        raise ObjError(f"has more than {MAX_TRIANGLES:,} triangles")


def end_of_block(data: bytes, start: int) -> int:
    """Return where the lines from a byte of a file on end, about `BLOCK_BYTES`, and what continues them; ObjError."""
    end = data.find(b"\n", start + BLOCK_BYTES - 1) + 1 or len(data)
    last = max(start, data.rfind(b"\n", start, end - 1) + 1)
    while end - last <= LONGEST_LINE and end < len(data) and data.endswith((b"\\\n", b"\\\r\n"), last, end):
        end = data.find(b"\n", end) + 1 or len(data)
    if end - last > LONGEST_LINE:
        raise ObjError(f"longer than {LONGEST_LINE // 2**20} MiB", obj_lines.line_of(data, end - 1))
    return end


def assemble(blocks: list[Block], data: bytes, folder: Path | None) -> Triangles:
    """Assemble the blocks of a file, `data`, into triangles, with the materials of files in `folder`.

    ObjError where the file has no triangle, names points that are not there, or has faces that cannot be cut.
    """
    if not any(len(block.sizes) for block in blocks):
        raise ObjError("has no faces")
    whole = Block(*map(np.concatenate, zip(*blocks, strict=True)))
    check_points(whole, data)
    notices = [*drop_absent(whole, data)]
    if len(whole.spoiled):
        notices.append(NOT_FINITE)
    if len(whole.unknown):
        first = line_of(data, whole.unknown[0])
        notices.append(f"has lines that begin with no word of .obj: they are skipped (the first is {first})")
    cut = triangulate(whole.points, whole.corners[:, 0], whole.sizes, lambda face: line_of(data, whole.starts[face]))
    cut = cut[non_degenerate(whole.points, whole.corners[cut, 0])]  # (m, 3) indices of corners
    if not len(cut):
        is_tiny = np.abs(whole.points[whole.corners[:, 0]]).max() < TINY
        what = f"a line, or larger than {TINY:g}" if is_tiny else "a line"
        raise ObjError(f"has no triangle that is more than {what}")
    corners, of_uvs, of_normals = (part[cut] for part in whole.corners.T.copy())
    uvs = normals = None
    if (of_uvs >= 0).any():
        uvs = np.where(of_uvs[..., None] >= 0, np.concatenate([whole.uvs, np.zeros((1, 2))])[of_uvs], 0.0)
    if (of_normals >= 0).any():
        flat = Triangles(whole.points, corners).flat_normals
        normals = corner_normals(whole.normals, of_normals, flat)
    colours = None
    if len(whole.colours) == len(whole.points):
        colours = np.rint(255 * np.clip(whole.colours, 0, 1)[corners].mean(axis=1)).astype(np.uint8)
        notices.append("has colours of points: each triangle has the mean of those of its corners")
    points, corners = used_points(whole.points, corners)
    if not folder or not len(whole.libraries):
        return Triangles(points, corners, normals, uvs, colours, notices=tuple(notices))
    numbers, materials, libraries = materials_of(whole, cut[:, 0], folder, notices)
    return Triangles(points, corners, normals, uvs, colours, numbers, materials, tuple(notices), libraries)


def materials_of(
    whole: Block, firsts: np.ndarray, folder: Path, notices: list[str]
) -> tuple[np.ndarray, tuple[Any, ...], tuple[Path, ...]]:
    """Return the index of the material of each triangle, (m,), the materials, and their files; add what is not used of
    them to the notices.

    `firsts` (m,) are the indices of the triangles' first corners. The first material is that of faces without one.
    """
    from minirt.meshes import mtl

    libraries = mtl.library_paths(whole.libraries, folder)
    found, unused = mtl.read_libraries(libraries, folder)
    names = ["", *whole.materials]
    index = {name: number for number, name in enumerate(dict.fromkeys(names))}
    if found and index.keys() - {"", *found}:
        unused.add("materials that no file has")
    if unused:
        notices.append(f"has materials of which this is not used: {', '.join(sorted(unused))}")
    faces = np.searchsorted(np.cumsum(whole.sizes), firsts, side="right")
    # How many lines `usemtl` precede each face: the number of its name in `names`.
    uses = np.searchsorted(whole.uses, whole.starts[faces])
    own = mtl.MeshMaterial()
    return np.array([index[name] for name in names])[uses], tuple(found.get(name, own) for name in index), libraries


def drop_absent(whole: Block, data: bytes) -> Iterator[str]:
    """Mark what corners name though it is not there as not named, and yield a notice about it."""
    for part, items in ((1, whole.uvs), (2, whole.normals)):
        indices = whole.corners[:, part]
        beyond = (indices >= len(items)) | (indices == NOWHERE)
        if beyond.any():
            indices[beyond] = ABSENT
            line = line_of(data, whole.starts[face_of(whole, int(np.argmax(beyond)))])
            yield f"has corners that name a {obj_lines.CORNER_PARTS[part]} that is not there (the first in line {line})"


def face_of(whole: Block, corner: int) -> int:
    """Return the index of the face of a corner."""
    return int(np.searchsorted(np.cumsum(whole.sizes), corner, side="right"))


def corner_normals(normals: np.ndarray, indices: np.ndarray, flat: np.ndarray) -> np.ndarray:
    """Return unit normals at corners, (m, 3, 3); a corner without one, index -1 or of length 0, has the flat normal."""
    padded = np.concatenate([normals, np.zeros((1, 3))])  # the last is that of index -1
    padded[squared_lengths(padded) > 0] = unit(padded[squared_lengths(padded) > 0])
    chosen = padded[indices]
    return np.where(squared_lengths(chosen)[..., None] > 0, chosen, flat[:, None])


def check_points(whole: Block, data: bytes) -> None:
    """Check that the file has all points that its corners name, and that these are finite; ObjError otherwise."""
    for start in whole.spoiled[np.isin(whole.spoiled[:, 0], whole.corners[:, 0]), 1].tolist():
        obj_lines.explain(data, start, 0)
    beyond = whole.corners[:, 0] >= len(whole.points)
    if beyond.any():
        corner = int(np.argmax(beyond))
        face = face_of(whole, corner)
        start, number = int(whole.starts[face]), corner - int(whole.sizes[:face].sum())
        column = obj_lines.words_of(obj_lines.logical_line(data, start))[1 + number].start() + 1
        raise ObjError(obj_lines.missing_point_message(len(whole.points)), line_of(data, start), column)
