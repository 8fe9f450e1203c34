"""Meshes of arrays, as other packages of Python have them: arrays -> triangles -> text of an .obj file."""

from __future__ import annotations

from hashlib import sha256
from typing import Any

import numpy as np

from minirt.errors import ElementError
from minirt.fields import FARTHEST
from minirt.meshes.obj import MAX_TRIANGLES, corner_normals
from minirt.meshes.obj_lines import ObjError
from minirt.meshes.polygons import triangulate
from minirt.meshes.triangles import Triangles, non_degenerate, used_points


def triangles_of(vertices: Any, faces: Any, normals: Any = None, uvs: Any = None) -> Triangles:
    """Return the triangles of arrays, which `minirt.Mesh.from_arrays` describes; ElementError where it says so."""
    points = numbers_of("vertices", vertices, 3)
    corners, sizes = corners_of(faces, len(points))
    try:
        cut = triangulate(points, corners, sizes, lambda _: 0)
    except ObjError as error:
        raise ElementError(f"mesh faces: {error}") from None
    triangles = corners[cut]
    triangles = triangles[non_degenerate(points, triangles)]
    if not len(triangles):
        raise ElementError("mesh faces have no triangle that is more than a line")
    if normals is not None:
        flat = Triangles(points, triangles).flat_normals
        normals = corner_normals(numbers_of("normals", normals, 3, len(points)), triangles, flat)
    if uvs is not None:
        uvs = numbers_of("uvs", uvs, 2, len(points))[triangles]
    return Triangles(*used_points(points, triangles), normals, uvs)


def numbers_of(name: str, values: Any, width: int, count: int | None = None) -> np.ndarray:
    """Return finite numbers (n, width), n the `count` if there is one; ElementError for others."""
    try:
        found = np.array(values, np.float64)
    except (TypeError, ValueError):
        found = np.empty(0)
    if found.ndim != 2 or found.shape[1] != width or count not in (None, len(found)):
        rows = "n" if count is None else count
        raise ElementError(f"mesh {name} must be an array ({rows}, {width}) of numbers, got {np.shape(found)}")
    if not np.abs(found).max(initial=0.0) <= FARTHEST:  # nor NaN
        raise ElementError(f"mesh {name} must be numbers of at most {FARTHEST:g}")
    return found


def corners_of(faces: Any, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices of the corners of all faces, (c,), and how many corners each face has, (m,).

    ElementError for anything but faces of three or more indices of `count` vertices, and for too many faces.
    """
    try:
        rows = faces if isinstance(faces, np.ndarray) else [np.asarray(face) for face in faces]
        sizes = np.array([len(row) for row in rows], np.int64)
        corners: np.ndarray = np.concatenate(rows)
    except (TypeError, ValueError):
        sizes, corners = np.zeros(0, np.int64), np.zeros(0)
    if not len(sizes) or sizes.min() < 3 or corners.ndim != 1 or corners.dtype.kind not in "iu":
        raise ElementError("mesh faces must be an array (m, 3) of indices of vertices, or a list of faces")
    if (sizes - 2).sum() > MAX_TRIANGLES:
        raise ElementError(f"mesh faces must be at most {MAX_TRIANGLES:,} triangles")
    beyond = corners[(corners < 0) | (corners >= count)]
    if len(beyond):
        raise ElementError(f"mesh faces must be indices of vertices, from 0 to {count - 1}, got {beyond[0]}")
    return corners.astype(np.int64), sizes


def digest(triangles: Triangles) -> str:
    """Return a hash of triangles without materials."""
    arrays = triangles.points, triangles.corners, triangles.normals, triangles.uvs
    return sha256(b"".join(b"" if each is None else each.tobytes() for each in arrays)).hexdigest()


def obj_text(triangles: Triangles) -> bytes:
    """Return triangles without materials as the text of an .obj file, in which all numbers have all of their digits."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in triangles.points.tolist()]
    form = "{0}"  # of a corner: its point, and the number of its texture coordinates and its normal
    if triangles.uvs is not None:
        lines += [f"vt {u!r} {v!r}" for u, v in triangles.uvs.reshape(-1, 2).tolist()]
        form = "{0}/{1}"
    if triangles.normals is not None:
        lines += [f"vn {x!r} {y!r} {z!r}" for x, y, z in triangles.normals.reshape(-1, 3).tolist()]
        form += "/{1}" if triangles.uvs is not None else "//{1}"
    corners = [form.format(point, own) for own, point in enumerate((triangles.corners.ravel() + 1).tolist(), 1)]
    lines += [f"f {' '.join(corners[start : start + 3])}" for start in range(0, len(corners), 3)]
    return "\n".join([*lines, ""]).encode()
