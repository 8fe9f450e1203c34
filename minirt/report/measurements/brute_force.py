"""Brute force: a packed scene without culling, in which every ray tries every shape."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from minirt.errors import RenderError
from minirt.kernel.frame import tile_count
from minirt.kernel.scene_arrays import SceneArrays
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene

EVERYWHERE = (0.0, 0.0, 0.0, -2.0, 0.0)  # a bounding cone of all directions, from distance 0 on
MOST = 2**24  # entries of all lists together


class BruteForce(Packing):
    """Packs scenes with all shapes in the list of every tile and of every light."""

    def pack_double(self, scene: Scene, width: int, height: int) -> SceneArrays:
        """Pack the scene; RenderError if the lists would fill the memory."""
        traced, count = super().pack_double(scene, width, height), tile_count(width) * tile_count(height)
        if count * len(traced.slots) > MOST:
            raise RenderError(f"{len(traced.slots)} shapes in each of {count} tiles are too many")
        return without_culling(traced, count)


def without_culling(traced: SceneArrays, tiles: int) -> SceneArrays:
    """Put all shapes into the list of each tile, and into one light-buffer cell around each light."""
    kinds, lamps = traced.slots[:, 0], len(traced.lights)
    members = np.argsort(kinds, kind="stable").astype(traced.tile_shapes.dtype)
    counts = np.bincount(kinds, minlength=len(traced.groups))
    starts = np.concatenate([[0], np.cumsum(counts)])
    # All lists of one kind come first, then all lists of the next kind.
    seen = [np.tile(members[a:b], tiles) for a, b in pairwise(starts)]
    lit = [members] * lamps
    return traced._replace(
        tile_shapes=np.concatenate(seen),
        cones=np.broadcast_to(np.array(EVERYWHERE), traced.cones.shape).copy(),
        light_buffer_cells=1,
        light_shapes=np.concatenate([members[:0], *lit]),
        light_cones=np.broadcast_to(np.array(EVERYWHERE), traced.light_cones.shape).copy(),
        groups=tuple(
            group._replace(
                tile_starts=tiles * starts[kind] + counts[kind] * np.arange(tiles + 1),
                light_starts=np.arange(lamps)[:, None] * len(kinds) + starts[kind : kind + 2],
            )
            for kind, group in enumerate(traced.groups)
        ),
    )
