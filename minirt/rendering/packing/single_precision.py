"""A packed scene in float32: less precise, and twice as many rays at once.

Everything is moved so that the eye is the origin before it is rounded, so what is precise is what is near the eye,
wherever in the world that is. What leaves shapes out is rounded to the safe side.
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.culling.light_buffer import SPREAD
from minirt.kernel.rows import kind_of, place_fields, row_type
from minirt.kernel.scene_arrays import Group, SceneArrays

MARGIN = 2.0**-21  # of a cosine: a few roundings of a scalar product of unit vectors


def in_single(traced: SceneArrays, boxes: np.ndarray) -> SceneArrays:
    """The scene in float32, the eye at the origin; `boxes` as in `minirt.rendering.packing.shape_arrays`."""
    eye = traced.camera[:3]
    looks = traced.colours_and_extents.copy()
    looks[:, 3] = np.abs(boxes[:, :3] - eye).max(axis=1) + boxes[:, 3]
    here = np.concatenate([eye, np.zeros(3)])
    return SceneArrays(
        camera=as_single(np.concatenate([np.zeros(3), traced.camera[3:]])),
        ambient=as_single(traced.ambient),
        lights=as_single(traced.lights - here),
        colours_and_extents=as_single(looks),
        slots=traced.slots,
        tile_shapes=traced.tile_shapes,
        cones=widened_cones(traced.cones),
        light_buffer_cells=traced.light_buffer_cells,
        light_buffers=narrowed_light_buffers(traced.light_buffers),
        light_shapes=traced.light_shapes,
        light_cones=widened_cones(traced.light_cones),
        groups=tuple(Group(rows_relative_to(group.rows, eye), group.tile_starts, group.light_starts) for group in traced.groups),
        spots=optional_single(traced.spots),
        specular=optional_single(traced.specular),
        surface_maps=traced.surface_maps and traced.surface_maps._replace(checks=optional_single(traced.surface_maps.checks)),
        background=optional_single(traced.background),
    )


def optional_single(numbers: np.ndarray | None) -> np.ndarray | None:
    """In float32, where there are such."""
    return None if numbers is None else as_single(numbers)


def as_single(numbers: np.ndarray) -> np.ndarray:
    """In float32, to nearest."""
    with np.errstate(over="ignore"):
        return numbers.astype(np.float32)


def widened_cones(views: np.ndarray) -> np.ndarray:
    """Views in float32: cones that have in them what was in the cones, also when a scalar product in float32 decides
    that, and distances that are not greater."""
    views = as_single(views)
    views[..., 3] -= MARGIN
    views[..., 4] = np.nextafter(views[..., 4], np.float32(-np.inf))
    return views


def narrowed_light_buffers(around: np.ndarray) -> np.ndarray:
    """How directions from lamps are sorted into cells, in float32: fewer count as close."""
    around = around.copy()
    around[:, SPREAD] = np.maximum(np.sqrt(around[:, SPREAD]) - MARGIN, 0.0) ** 2
    return as_single(around)


def rows_relative_to(rows: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Rows of shapes in float32, relative to the eye."""
    kind = kind_of(rows.dtype.names)
    rows = rows.copy()
    for name in place_fields(kind):
        rows[name] -= eye
    with np.errstate(over="ignore"):
        return rows.astype(row_type(kind, np.float32))
