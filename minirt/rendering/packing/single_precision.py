"""Converts a packed scene to float32: less precise, and twice as many rays per SIMD register.

Everything is moved so that the eye is the origin before it is rounded. So whatever is near the eye is precise, wherever
in the world that is. Bounds used for culling are rounded to the safe side.
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.scene_arrays import SceneArrays, kind_of, point_fields, row_type
from minirt.kernel.shading.patterns import ORIGIN, Patterns
from minirt.kernel.shadow_rays import TOLERANCE

MARGIN = 2.0**-21  # of a cosine: a few roundings of a scalar product of unit vectors


def in_single(arrays: SceneArrays, boxes: np.ndarray) -> SceneArrays:
    """Return a scene in float32, the eye at the origin; `boxes` as in `minirt.rendering.packing.shape_arrays`."""
    eye = arrays.camera[:3]
    colours_and_extents = arrays.colours_and_extents.copy()
    colours_and_extents[:, 3] = np.abs(boxes[:, :3] - eye).max(axis=1) + boxes[:, 3]
    eye_and_no_light = np.concatenate([eye, np.zeros(3)])
    return SceneArrays(
        camera=as_single(np.concatenate([np.zeros(3), arrays.camera[3:]])),
        ambient=as_single(arrays.ambient),
        lights=as_single(arrays.lights - eye_and_no_light),
        colours_and_extents=as_single(colours_and_extents),
        slots=arrays.slots,
        tile_shapes=arrays.tile_shapes,
        cones=widened_cones(arrays.cones),
        light_buffer_cells=arrays.light_buffer_cells,
        light_buffers=narrowed_light_buffers(arrays.light_buffers),
        light_shapes=arrays.light_shapes,
        light_cones=widened_cones(arrays.light_cones),
        groups=tuple(group._replace(rows=rows_relative_to(group.rows, eye)) for group in arrays.groups),
        spots=optional_single(arrays.spots),
        soft=optional_single(arrays.soft),
        lens=optional_single(arrays.lens),
        specular=optional_single(arrays.specular),
        glow=optional_single(arrays.glow),
        surface_maps=arrays.surface_maps
        and arrays.surface_maps._replace(
            checks=optional_single(arrays.surface_maps.checks),
            placements=optional_single(arrays.surface_maps.placements),
        ),
        patterns=arrays.patterns and patterns_relative_to(arrays.patterns, eye),
        smooth=arrays.smooth,
        background=optional_single(arrays.background),
    )


def optional_single(numbers: np.ndarray | None) -> np.ndarray | None:
    """Round an optional array to float32; None stays None."""
    return None if numbers is None else as_single(numbers)


def patterns_relative_to(patterns: Patterns, eye: np.ndarray) -> Patterns:
    """Move the frames of patterns so that the eye is the origin, and round them to float32."""
    rows = patterns.rows.copy()
    rows[:, ORIGIN : ORIGIN + 3] -= eye
    return patterns._replace(rows=as_single(rows), heights=optional_single(patterns.heights))


def as_single(numbers: np.ndarray) -> np.ndarray:
    """Round to the nearest float32."""
    with np.errstate(over="ignore"):
        return numbers.astype(np.float32)


def widened_cones(cones: np.ndarray) -> np.ndarray:
    """Round bounding cones to float32 so that they enclose the given ones and their distances are not greater.

    That holds also when a scalar product in float32 decides whether a direction is inside.
    """
    cones = as_single(cones)
    cones[..., 3] -= MARGIN
    cones[..., 4] = np.nextafter(cones[..., 4], np.float32(-np.inf))
    return cones


def narrowed_light_buffers(light_buffers: np.ndarray) -> np.ndarray:
    """Round the parameters of light buffers to float32 so that fewer directions count as close to another."""
    light_buffers = light_buffers.copy()
    light_buffers[:, TOLERANCE] = np.maximum(np.sqrt(light_buffers[:, TOLERANCE]) - MARGIN, 0.0) ** 2
    return as_single(light_buffers)


def rows_relative_to(rows: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Move rows of shapes so that the eye is the origin, and round them to float32."""
    kind = kind_of(rows.dtype.names)
    rows = rows.copy()
    for name in point_fields(kind):
        rows[name] -= eye
    with np.errstate(over="ignore"):
        return rows.astype(row_type(kind, np.float32))
