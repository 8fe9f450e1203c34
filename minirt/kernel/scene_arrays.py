"""Structure of arrays of a scene, as the kernel reads it: all numbers float64, or all float32.

Packed shapes are record arrays, one for each kind, with a row for each shape. The names of a row's fields begin with
the title of the kind: the dtype of an array tells which formulas belong to it.
"""

from __future__ import annotations

from collections.abc import Callable
from ctypes import POINTER, c_double, c_float, cast
from functools import cache
from typing import Any, NamedTuple, get_type_hints

import numpy as np

from minirt.lanes import Mask, Number, Vec, rounded_product
from minirt.lanes.memory import prefetch
from minirt.shapes import ALL_KINDS, Kind
from minirt.shapes.shape import Position
from minirt.shapes.smooth_triangle import PackedMeshTriangle

AXIS, COSINE, LEAST_DISTANCE = 0, 3, 4  # columns of bounding cones, see `SceneArrays`
KIND, ROW, PRIMITIVE, SHAPE = 0, 1, 2, 3  # columns of `SceneArrays.listed`
Rows = Any  # an array of dtype `row_type(kind)`
TRIANGLE_ROW = np.dtype([("mesh.corners", np.int32, (3,))])
LEVELS = 32  # levels of a binary tree of boxes, at most, down to leaves


class Group(NamedTuple):
    """All shapes of one kind, with the index ranges of those that each screen tile and light-buffer cell can see.

    Shapes of this kind in tile c: `tile_shapes[tile_starts[c]:tile_starts[c + 1]]` of the scene. Shapes of this kind in
    cell c of light i: `light_shapes[light_starts[i, c]:light_starts[i, c + 1]]`. A mesh is there by its first triangle.
    A kind that the scene lacks has no rows.
    """

    rows: Any  # a row for each shape; of meshes, one of `TRIANGLE_ROW` for each triangle
    tile_starts: Any  # (tiles + 1,)
    light_starts: Any  # (m, cells + 1)
    number: int  # of the group in `SceneArrays.slots`; -1 without rows
    trees: Any = None  # of meshes: `minirt.kernel.bvh_nodes.MeshTrees`
    triangles: Any = None  # of meshes


class MeshTriangles(NamedTuple):
    """The m triangles of all k meshes of a scene, by the indices of their corners among n points."""

    points: Any  # (n, 3) in the scene
    normals: Any  # (m, 3) unit normals of the planes of triangles
    corners: Any  # int32 (m, 3)
    numbers: Any  # int32 (m,) the number of the mesh of each triangle
    turns: Any  # (k, 9) vectors along the x, y and z axis of each mesh's file
    shading: Any  # (m, 9) normals at the corners, in the file's space; zeros, or one row of them, where it has none
    uvs: Any  # (m, 6) texture coordinates at the corners, or one row for all triangles


class SceneArrays(NamedTuple):
    """All that a frame is rendered from: m lights and n shapes, numbered from 0 in the order of the scene file.

    A bounding cone encloses a shape as seen from a point. Its five numbers are the axis, the cosine of the half-angle
    (-2 if the cone takes in all directions) and a lower bound of the distance from the point to the shape.
    """

    # (14,) eye; direction through the upper left corner of the picture; its change by a pixel to the right, and by one
    # down; column and row of the picture at which the rendered rectangle begins
    camera: Any
    ambient: Any  # (3,) radiance of ambient light: red, green, blue
    lights: Any  # (m, 6) position and intensity of each light source
    colours_and_extents: Any  # (n, 4) colour of each shape, red green blue in [0, 1], and its largest coordinate
    slots: Any  # (n, 2) index of each shape's group, and of its row in that group
    listed: Any  # int32 (s, 4) group, row, index of the first primitive, and index of each shape, as lists number them
    tile_shapes: Any  # shapes of all tiles, those of a tile and kind sorted by distance; behind them room for more
    cones: Any  # (s, 5) bounding cones as seen from the eye
    square: int  # pixels along an edge of the squares of the screen that have lists: a tile, or less in a crowd
    light_buffer_cells: int  # cells along an edge of a light buffer's cube; 1 if light buffers are not used
    light_shapes: Any  # shapes of all cells of all light buffers, those of a cell and kind sorted by distance
    light_cones: Any  # (m, s, 5) bounding cones as seen from each light
    groups: Any  # a tuple of Group: one for each kind of shape in the scene
    # Features that most scenes lack. A field that is None adds no code to the kernel; an array without rows means that
    # the kernel has the feature and the scene lacks it.
    spots: Any = None  # (m, 7) spot, parallel and fading lights, see `minirt.kernel.shading.lights`
    light_grid: Any = None  # `minirt.kernel.shading.lights.LightGrid`, where there are `spots`
    soft: Any = None  # (m, 4) light sources with a size, see `minirt.kernel.shading.lights`
    lens: Any = None  # (7,) half axes of the camera's lens, and one over the distance at which it is sharp
    specular: Any = None  # (n, 3) specular highlights, see `minirt.kernel.shading.lights`
    reflective: Any = None  # (n, 3) mirrors and glass, see `minirt.kernel.shading.whitted`
    transparent: Any = None  # (n, 5) glass as light from light sources meets it, `minirt.kernel.shading.shade`
    media: Any = None  # (n, 6) tinted glass, see `minirt.kernel.shading.surfaces`
    eye_medium: Any = None  # (3,) absorption at the eye, likewise
    fresnel: Any = None  # (n,) how far the shares of mirrors and glass are those of Fresnel's equations, from 0 to 1
    fades: Any = None  # (n, 2) one over the distances at which reflected and refracted rays are gone, or 0
    glow: Any = None  # (n,) share of its colour that a shape emits
    smooth: Any = None  # (n,) 1 for the triangles of smooth meshes, else 0, see `minirt.kernel.shading.shade`
    surface_maps: Any = None  # `minirt.kernel.shading.texturing.SurfaceMaps`
    patterns: Any = None  # `minirt.kernel.shading.patterns.Patterns`
    depth: int = 0  # most reflections and refractions along a path
    background: Any = None  # (3,) radiance along rays that hit nothing
    environment: Any = None  # `minirt.kernel.shading.texturing.Environment`
    bvh: Any = None  # `minirt.kernel.bvh_nodes.Tree` of the shapes, for incoherent rays


def has_rows(table: Any) -> bool:
    """Whether an array of a feature, or the rows of a kind of shape, show that the scene has it.

    The compiler knows the answer for None: there is no code then for what the feature needs.
    """
    return table is not None and bool(table.shape[0] > 0)


def vector(row: Any, at: int) -> Vec:
    """Return the Vec of three numbers of a row."""
    return Vec(row[at], row[at + 1], row[at + 2])


def store_vec(vectors: Any, i: int, v: Vec) -> None:
    """Store a vector in row i of an array (n, 3)."""
    vectors[i, 0], vectors[i, 1], vectors[i, 2] = v.x, v.y, v.z


def range_in_tile(group: Group, tile: int) -> tuple[int, int]:
    """Return the range in `SceneArrays.tile_shapes` of the shapes of one kind in a tile."""
    if not has_rows(group.rows):
        return 0, 0
    return int(group.tile_starts[tile]), int(group.tile_starts[tile + 1])


def range_in_cell(group: Group, light: int, cell: int) -> tuple[int, int]:
    """Return the range in `SceneArrays.light_shapes` of the shapes of one kind in a light-buffer cell."""
    if not has_rows(group.rows):
        return 0, 0
    return int(group.light_starts[light, cell]), int(group.light_starts[light, cell + 1])


@cache
def row_type(kind: Kind, number: type = np.float64) -> np.dtype[Any]:
    """Return the record dtype of the rows of a kind, with components of type `number`."""
    hints = get_type_hints(kind.packed).items()
    return np.dtype([(field_name(kind, name), number, (3,) if hint in (Vec, Position) else ()) for name, hint in hints])


def field_name(kind: Kind, name: str) -> str:
    """Return the name of the row field that holds a number or Vec of a packed shape."""
    return f"{kind.element.title}.{name}"


@cache
def row_axes(kind: Kind) -> tuple[int, ...]:
    """Return the axis of each number of a row that is a coordinate of a point, and 3 for other numbers."""
    axes = {Position: (0, 1, 2), Vec: (3, 3, 3)}
    return tuple(axis for hint in get_type_hints(kind.packed).values() for axis in axes.get(hint, (3,)))


def kind_of(fields: Any) -> Kind:
    """Return the kind whose rows have these field names."""
    title = next(iter(fields)).split(".")[0]
    return next(kind for kind in ALL_KINDS if kind.element.title == title)


def to_single(table: Any, kinds: Any, shifts: Any) -> None:
    """Round a table to float32, each column less its shift, see `minirt.kernel.moving_camera.Followers`."""
    (numbers, rounded), columns = numbers_at(table[0], table[4]), table[2]
    for row in range(table[1]):
        for column in range(columns):
            at = row * columns + column
            rounded[at] = numbers[at] - shifts[kinds[table[3] + column]]


def numbers_at(doubles: int, singles: int) -> tuple[Any, Any]:
    """Return the float64 numbers from an address on, and the float32 numbers from another one on."""
    return cast(int(doubles), POINTER(c_double)), cast(int(singles), POINTER(c_float))


def read(rows: Rows, i: int) -> Any:
    """Return the packed shape in row i."""
    parts = (Vec(*part) if np.ndim(part) else part for part in rows[i])
    return kind_of(rows.dtype.names).packed(*parts)


def read_row(group: Any, row: int) -> Any:
    """Return the packed shape, or the packed triangle of a mesh, in a row of a group."""
    if group.triangles is None:
        return read(group.rows, row)
    triangles, points, corners = group.triangles, group.triangles.points, group.triangles.corners[row]
    a: Any = vector(points[corners[0]], 0)
    b: Any = vector(points[corners[1]], 0)
    c: Any = vector(points[corners[2]], 0)
    turn, at = triangles.turns[triangles.numbers[row]], triangles.shading[min(row, triangles.shading.shape[0] - 1)]
    normal: Any = vector(triangles.normals[row], 0)
    at_a, at_b, at_c = turned(turn, vector(at, 0)), turned(turn, vector(at, 3)), turned(turn, vector(at, 6))
    uv = triangles.uvs[min(row, triangles.uvs.shape[0] - 1)]
    return PackedMeshTriangle(a, b, c, normal, at_a, at_b, at_c, uv[0], uv[1], uv[2], uv[3], uv[4], uv[5])


def prefetch_triangle(triangles: MeshTriangles, row: int) -> None:
    """Prefetch what `read_row` reads of a triangle to intersect it."""
    prefetch(triangles.normals[row], 0)
    for corner in range(3):
        prefetch(triangles.points[triangles.corners[row, corner]], 0)


def turned(turn: Any, v: Vec) -> Vec:
    """Turn a vector of a mesh's file into the scene, rounded as by `minirt.shapes.mesh.Mesh.turned`."""
    return scaled(vector(turn, 0), v.x) + scaled(vector(turn, 3), v.y) + scaled(vector(turn, 6), v.z)


def scaled(v: Vec, scale: Number) -> Vec:
    """Return a vector times a number, rounded: never fused with a sum that follows."""
    return Vec(rounded_product(v.x, scale), rounded_product(v.y, scale), rounded_product(v.z, scale))


def read_block(blocks: Any, i: int) -> Any:
    """Return all shapes of a block as one packed shape, with one shape in each SIMD lane."""
    parts = (Vec(*part) if part.ndim == 2 else part for part in blocks[i])
    return kind_of(blocks.dtype.names).packed(*parts)


def read_one(blocks: Any, block: int, i: int) -> Any:
    """Return the packed shape in lane i of a block."""
    parts = (Vec(*part[:, i]) if part.ndim == 2 else part[i] for part in blocks[block])
    return kind_of(blocks.dtype.names).packed(*parts)


def kind_of_packed(packed: type[Any]) -> Kind:
    """Return the kind that has this class as its packed form."""
    return next(kind for kind in ALL_KINDS if kind.packed is packed)


def of_kind(name: str) -> Callable[..., Any]:
    """Return the function that calls the formula of this name, see `minirt.shapes.shape`, of a packed shape's kind."""
    return lambda shape, *arguments: getattr(kind_of_packed(type(shape)), name)(shape, *arguments)


formula, may_meet, surface = of_kind("intersect"), of_kind("may_meet"), of_kind("surface")
mapping, shading, smooth_point = of_kind("mapping"), of_kind("shading"), of_kind("smooth_point")


def intersect(shape: Any, origin: Vec, direction: Vec) -> Any:
    """Intersect rays, which may start anywhere, with a packed shape."""
    return formula(shape, origin, direction, None)


def is_convex(shape: Any) -> bool:
    """Whether the kind of a packed shape is convex; the compiler knows the answer."""
    return kind_of_packed(type(shape)).element.convex


def occludes(shape: Any, origin: Vec, direction: Vec, limit: Number) -> Mask:
    """Whether shadow rays, which start clear of all surfaces, hit a packed shape nearer than `limit`."""
    hit, t = formula(shape, origin, direction, limit)
    return hit & (t < limit)
