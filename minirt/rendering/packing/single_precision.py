"""A packed scene in float32: less precise, and twice as many rays at once.

Everything is moved so that the eye is the origin before it is rounded, so what is precise is what is near the eye,
wherever in the world that is. What leaves shapes out is rounded to the safe side.
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.culling.light_buffer import TOLERANCE
from minirt.kernel.rows import kind_of, point_fields, row_type
from minirt.kernel.scene_arrays import Group, SceneArrays

MARGIN = 2.0**-21  # of a cosine: a few roundings of a scalar product of unit vectors


def in_single(traced: SceneArrays, boxes: np.ndarray) -> SceneArrays:
    """The scene in float32, the eye at the origin; `boxes` as in `minirt.rendering.packing.shape_arrays`."""
    eye = traced.camera[:3]
    looks = traced.colours_and_extents.copy()
    looks[:, 3] = np.abs(boxes[:, :3] - eye).max(axis=1) + boxes[:, 3]
    here = np.concatenate([eye, np.zeros(3)])
    return SceneArrays(
        camera=rounded(np.concatenate([np.zeros(3), traced.camera[3:]])),
        ambient=rounded(traced.ambient),
        lights=rounded(traced.lights - here),
        colours_and_extents=rounded(looks),
        slots=traced.slots,
        tile_shapes=traced.tile_shapes,
        cones=wider(traced.cones),
        light_buffer_cells=traced.light_buffer_cells,
        light_buffers=narrower(traced.light_buffers),
        light_shapes=traced.light_shapes,
        light_cones=wider(traced.light_cones),
        groups=tuple(Group(moved(group.rows, eye), group.tile_starts, group.light_starts) for group in traced.groups),
        spots=known(traced.spots),
        specular=known(traced.specular),
        surface_maps=traced.surface_maps and traced.surface_maps._replace(checks=known(traced.surface_maps.checks)),
        background=known(traced.background),
    )


def known(numbers: np.ndarray | None) -> np.ndarray | None:
    """In float32, where there are such."""
    return None if numbers is None else rounded(numbers)


def rounded(numbers: np.ndarray) -> np.ndarray:
    """In float32, to nearest."""
    with np.errstate(over="ignore"):
        return numbers.astype(np.float32)


def wider(views: np.ndarray) -> np.ndarray:
    """Views in float32: cones that have in them what was in the cones, also when a scalar product in float32 decides
    that, and distances that are not greater."""
    views = rounded(views)
    views[..., 3] -= MARGIN
    views[..., 4] = np.nextafter(views[..., 4], np.float32(-np.inf))
    return views


def narrower(around: np.ndarray) -> np.ndarray:
    """How directions from lamps are sorted into cells, in float32: fewer count as close."""
    around = around.copy()
    around[:, TOLERANCE] = np.maximum(np.sqrt(around[:, TOLERANCE]) - MARGIN, 0.0) ** 2
    return rounded(around)


def moved(rows: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Rows of shapes in float32, relative to the eye."""
    kind = kind_of(rows.dtype.names)
    rows = rows.copy()
    for name in point_fields(kind):
        rows[name] -= eye
    with np.errstate(over="ignore"):
        return rows.astype(row_type(kind, np.float32))
