"""Packed scenes without culling: without the lists of tiles, of light buffers, or the boxes of the BVH."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import inf

import numpy as np

from minirt.errors import RenderError
from minirt.kernel.bvh_nodes import NODE, REFERENCES, Tree
from minirt.kernel.frame import tile_count
from minirt.kernel.scene_arrays import SceneArrays
from minirt.rendering.packing.camera import Crop
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene

EVERYWHERE = (0.0, 0.0, 0.0, -2.0, 0.0)  # a bounding cone of all directions, from distance 0 on
MOST = 2**24  # entries of all lists together
Change = Callable[[SceneArrays, int], SceneArrays]  # of the arrays of a picture of so many tiles


class ChangedPacking(Packing):
    """Packs scenes and changes their arrays in one or more ways."""

    def __init__(self, *changes: Change, precision: str = "double") -> None:
        super().__init__(precision=precision)
        self.changes = changes

    def pack_double(self, scene: Scene, width: int, height: int, crop: Crop) -> SceneArrays:
        """Pack the scene; RenderError if its lists would fill the memory."""
        arrays = super().pack_double(scene, width, height, crop)
        for change in self.changes:
            arrays = change(arrays, tile_count(width) * tile_count(height))
        return arrays


def without_tiles(arrays: SceneArrays, tiles: int) -> SceneArrays:
    """Put all shapes into the list of each tile."""
    if tiles * len(arrays.slots) > MOST:
        raise RenderError(f"{len(arrays.slots)} shapes in each of {tiles} tiles are too many")
    members, starts = shapes_by_kind(arrays)
    counts = np.diff(starts)
    return arrays._replace(
        # All lists of one kind come first, then all lists of the next kind.
        tile_shapes=np.concatenate([np.tile(members[a:b], tiles) for a, b in pairwise(starts)]),
        cones=np.broadcast_to(np.array(EVERYWHERE), arrays.cones.shape).copy(),
        groups=tuple(
            group._replace(tile_starts=tiles * starts[kind] + counts[kind] * np.arange(tiles + 1))
            for kind, group in enumerate(arrays.groups)
        ),
    )


def without_light_buffers(arrays: SceneArrays, _: int) -> SceneArrays:
    """Put all shapes into one light-buffer cell around each light."""
    members, starts = shapes_by_kind(arrays)
    lights = len(arrays.lights)
    return arrays._replace(
        light_buffer_cells=1,
        light_shapes=np.concatenate([members[:0], *[members] * lights]),
        light_cones=np.broadcast_to(np.array(EVERYWHERE), arrays.light_cones.shape).copy(),
        groups=tuple(
            group._replace(light_starts=np.arange(lights)[:, None] * len(members) + starts[kind : kind + 2])
            for kind, group in enumerate(arrays.groups)
        ),
    )


def without_boxes(arrays: SceneArrays, _: int) -> SceneArrays:
    """Widen all boxes of the BVH to all of space, so that each ray visits every leaf."""
    tree: Tree | None = arrays.bvh
    if tree is None:
        return arrays
    nodes = tree.nodes.copy()
    boxes = nodes.reshape(-1, NODE)[:, :REFERENCES]
    low, high = np.split(boxes, 2, axis=1)
    used = low <= high  # an unused child has an empty box
    low[used], high[used] = -inf, inf
    return arrays._replace(bvh=tree._replace(nodes=nodes))


def shapes_by_kind(arrays: SceneArrays) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers of all shapes, sorted by kind, and where each kind starts, with the end of the last one."""
    kinds = arrays.slots[:, 0]
    members = np.argsort(kinds, kind="stable").astype(arrays.tile_shapes.dtype)
    return members, np.concatenate([[0], np.cumsum(np.bincount(kinds, minlength=len(arrays.groups)))])
