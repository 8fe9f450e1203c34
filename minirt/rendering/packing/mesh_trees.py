"""The trees of meshes, each built once for its file, and the triangles of meshes, placed in the scene."""

from __future__ import annotations

from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from minirt.kernel.bvh_build import INDEX
from minirt.kernel.bvh_nodes import HUGE, NODE, MeshTrees
from minirt.kernel.machine_code.library import bound
from minirt.kernel.scene_arrays import ROW, MeshTriangles
from minirt.meshes import Triangles
from minirt.meshes.triangles import BLOCK
from minirt.rendering.packing.bvh import Meshes, aligned_copy, wide_nodes
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.visibility import PARALLEL, Run
from minirt.shapes.mesh import Mesh
from minirt.shapes.smooth_triangle import BARYCENTRIC

trees: WeakKeyDictionary[Triangles, np.ndarray] = WeakKeyDictionary()  # float32 nodes


def pack_meshes(shapes: ShapeArrays, kernel: Any, run: Run | None = None) -> Meshes:
    """Return the trees of the meshes of a scene, and the triangles of all of them."""
    return mesh_trees(shapes, kernel, run), place_meshes(shapes, kernel, run)


def mesh_trees(shapes: ShapeArrays, kernel: Any, run: Run | None = None) -> MeshTrees | None:
    """Return the trees of the meshes of a scene, built with the functions of `kernel` where they are not yet, or None
    without any."""
    if Mesh not in shapes.group_numbers:
        return None
    owners = [index for index, shape in enumerate(shapes.shapes) if isinstance(shape, Mesh)]
    meshes: Any = [shapes.shapes[index] for index in owners]
    nodes = [tree_of(mesh.triangles, kernel, run) for mesh in meshes]
    roots = np.cumsum([0, *map(len, nodes[:-1])]) // NODE  # of each tree the number of its first node
    first = shapes.first_primitive[owners]
    rows = shapes.slots[first, ROW]  # of the first triangle of each mesh, in the table of all triangles, ascending
    numbers = np.zeros(rows[-1] + 1, np.int64)  # of meshes, by these rows; nothing asks for others
    numbers[rows] = np.arange(len(rows))
    joined = np.concatenate(nodes) if len(nodes) > 1 else nodes[0]
    return MeshTrees(joined, np.stack([roots, first], axis=1), np.array(list(map(place_of, meshes))), numbers)


def place_of(mesh: Mesh) -> np.ndarray:
    """Return a row of `minirt.kernel.bvh_nodes.MeshTrees.places`."""
    middle, size = space_of(mesh.triangles)
    (centre,) = mesh.placed(middle[None])
    apart = np.abs(centre - mesh.position).max()
    return np.array([*mesh.turned(np.eye(3)).ravel(), *centre, 1.0 / (size * mesh.scale), apart])


def space_of(triangles: Triangles) -> tuple[np.ndarray, float]:
    """Return what is the origin of a tree's space in the mesh's file, and what is 1 there."""
    low, high = triangles.box
    return (low + high) / 2, float((high - low).max() / 2)


def tree_of(triangles: Triangles, kernel: Any, run: Run | None = None) -> np.ndarray:
    """Return the nodes of the tree of a mesh, flat, float32, see `minirt.kernel.bvh_nodes`. The tree is built at the
    first call: inner nodes, then leaves."""
    if triangles not in trees:
        middle, size = space_of(triangles)
        boxes = boxes_of_triangles(triangles, middle, size)
        nodes, places, spare = wide_nodes(boxes, kernel, run=run)
        inside = boxes[places, INDEX].astype(np.int64)
        del boxes
        leaves = nodes[len(nodes) - len(inside) :]
        corners = (((triangles.points - middle) / size).astype(np.float32))[triangles.corners[inside]]
        corners[spare] = HUGE
        leaves[:, (0, 1, 2, 3, 4, 5, 7, 8, 9)] = corners.reshape(*inside.shape, 9).transpose(0, 2, 1)
        leaves[:, 6] = -1 - inside
        trees[triangles] = aligned_copy(nodes)
    return trees[triangles]


def boxes_of_triangles(triangles: Triangles, middle: np.ndarray, size: float) -> np.ndarray:
    """Return the boxes of n triangles as those of `BinaryTree`, (n, 8), in the space of `space_of`, with the numbers of
    the triangles as indices."""
    boxes = np.zeros((len(triangles), 8))
    columns = [(triangles.points[:, axis] - middle[axis]) / size for axis in range(3)]
    for start in range(0, len(boxes), BLOCK):
        corners = triangles.corners[start : start + BLOCK].T
        for axis, (a, b, c) in enumerate([numbers[each] for each in corners] for numbers in columns):
            boxes[start : start + BLOCK, axis] = -np.minimum(np.minimum(a, b), c)
            boxes[start : start + BLOCK, 3 + axis] = np.maximum(np.maximum(a, b), c)
    boxes[:, INDEX] = np.arange(len(boxes))
    return boxes


# Triangles of meshes.


def place_meshes(shapes: ShapeArrays, kernel: Any, run: Run | None = None) -> MeshTriangles | None:
    """Return the triangles of all meshes of a scene, or None without any.

    `shapes.triangles` keeps them, and `shapes.placed` the meshes as they were placed: only meshes that have changed are
    placed anew, by a function of `kernel`, on all threads by `run`. Shapes of other numbers or files empty both.
    """
    if Mesh not in shapes.group_numbers:
        return None
    meshes = [shape for shape in shapes.shapes if isinstance(shape, Mesh)]
    files, sizes = [mesh.triangles for mesh in meshes], [mesh.parts for mesh in meshes]
    points, rows = np.cumsum([0, *(len(file.points) for file in files)]), np.cumsum([0, *sizes])  # the first of each
    if shapes.triangles is None:
        corners_of_files = [file.corners + first for file, first in zip(files, points, strict=False)]
        shapes.triangles = MeshTriangles(
            points=np.empty((points[-1], 3)),
            normals=np.empty((rows[-1], 3)),
            corners=np.concatenate(corners_of_files, dtype=np.int32, casting="same_kind"),
            numbers=np.repeat(np.arange(len(meshes), dtype=np.int32), sizes),
            turns=np.empty((len(meshes), 9)),
            shading=joined([file.normals for file in files], sizes, np.zeros(9)),
            uvs=joined([file.uvs for file in files], sizes, np.array(BARYCENTRIC)),
        )
    for number, mesh in enumerate(meshes):
        if mesh is not shapes.placed.get(number):
            file, first, end = files[number], points[number], points[number + 1]
            own_rows = slice(rows[number], rows[number + 1])
            shapes.triangles.turns[number] = turn = mesh.turned(np.eye(3)).ravel()
            source = np.array([*turn, mesh.scale, *mesh.position]), file.points, file.flat_normals, int(first)
            corners, normals = shapes.triangles.corners[own_rows], shapes.triangles.normals[own_rows]
            into = corners, shapes.triangles.points[first:end], normals  # the last two of which are overwritten
            counter = np.zeros(1, np.int64)  # from which threads take their parts
            job = bound(kernel.place_triangles, counter, *source, *into)
            if run and mesh.parts >= PARALLEL:
                run(job)
            else:
                job()
            shapes.placed[number] = mesh
    triangles: MeshTriangles = shapes.triangles
    return triangles


def joined(parts: list[np.ndarray | None], sizes: list[int], default: np.ndarray) -> np.ndarray:
    """Join rows of triangles, the default for a file without any; one such row where no file has any."""
    if all(part is None for part in parts):
        return default[None]
    tables = (np.tile(default, (n, 1)) if part is None else part for part, n in zip(parts, sizes, strict=True))
    rows = [np.ascontiguousarray(table.reshape(len(table), -1)) for table in tables]
    return rows[0] if len(rows) == 1 else np.concatenate(rows)
