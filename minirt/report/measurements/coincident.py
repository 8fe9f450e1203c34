"""Find coincident surfaces: pairs so close together that rounding decides which of them is seen (z-fighting)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np

from minirt.kernel.frame import ray_direction
from minirt.kernel.scene_arrays import kind_of_packed
from minirt.kernel.trace import ROUNDING
from minirt.lanes import Vec, dot, unit
from minirt.rendering.notes import shape_name
from minirt.rendering.packing.camera import camera_numbers, packed_columns, pixel_rays
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.report.measurements.stiffness import DOUBLE, SINGLE, Stiff
from minirt.scene import Scene

ACROSS, DOWN = 64, 36  # test rays over the whole picture
LEAST = 4  # test rays that must show two close surfaces: where surfaces cross, a ray may do so by chance
MOST_SHAPES = 1000  # shapes or mesh triangles; larger scenes are not tested
TIE = 4 * ROUNDING  # unit roundoffs up to which `minirt.kernel.trace.closer_hit` takes two surfaces for one
CLOSE = 1000  # times TIE: surfaces that nearly coincide


def coincident(scene: Scene, tables: ShapeArrays) -> Iterator[Stiff]:
    """Yield the pairs of shapes whose surfaces coincide, or nearly coincide, as seen from the eye."""
    if not 2 <= len(tables.owner) <= MOST_SHAPES:
        return
    camera = pixel_rays(camera_numbers(scene.camera, ACROSS, DOWN), ACROSS, DOWN)
    y, x = np.mgrid[:DOWN, :ACROSS].reshape(2, -1) + 0.5
    eye, ways = camera[:3], unit(ray_direction(camera, x, y))
    with np.errstate(all="ignore"):
        t, slopes = all_hits(tables, Vec(*eye), ways)
        pair = np.argsort(t, axis=0, kind="stable")[:2]
        near, far = np.take_along_axis(t, pair, axis=0)
        gap = (far - near) * np.take_along_axis(slopes, pair[:1], axis=0)[0]  # between the surfaces
        points = near * np.stack([ways.x, ways.y, ways.z])
        reach = np.abs(tables.boxes[:, :3] - eye).max(axis=1) + tables.boxes[:, 3]
        world = np.abs(points + eye[:, None]).max(axis=0) + np.abs(eye).max()
        double = gap / (TIE * DOUBLE * (world + tables.colours_and_extents[pair, 3].max(axis=0)))
        single = gap / (TIE * SINGLE * (np.abs(points).max(axis=0) + reach[pair].max(axis=0)))
        close = (double <= CLOSE) | (single <= 1)
    close &= tables.owner[pair[0]] != tables.owner[pair[1]]  # parts of a mesh have edges in common
    pairs = Counter(zip(*np.sort(pair[:, close], axis=0).tolist(), strict=True))
    for (one, other), count in pairs.items():
        selected = close & (pair.min(axis=0) == one) & (pair.max(axis=0) == other)
        ties = {"double": float(np.median(double[selected])), "single": float(np.median(single[selected]))}
        shared = " and ".join(precision for precision, gaps in ties.items() if gaps <= 1)
        if count >= LEAST:
            yield Stiff(
                f"{shape_name(tables, one)} and {shape_name(tables, other)}",
                f"taken for one surface in {shared} precision: the first is shown" if shared else "nearly coincide",
                {"share of the picture": count / t.shape[1], "gap": float(np.median(gap[selected]))}
                | {f"in roundings, {precision}": gaps for precision, gaps in ties.items()},
            )


def all_hits(tables: ShapeArrays, eye: Vec, ways: Vec) -> tuple[np.ndarray, np.ndarray]:
    """For each shape and ray return the hit distance, infinity for a miss, and the cosine of ray and normal."""
    t, slopes = np.empty((2, len(tables.owner), len(ways.x)))
    for index, (group, row) in enumerate(tables.slots):
        packed = packed_columns(tables.rows[group][row : row + 1])
        kind = kind_of_packed(type(packed))
        hit, at = kind.intersect(packed, eye, ways)
        _, normal = kind.surface(packed, eye + at * ways)
        t[index] = np.where(hit, at, np.inf)
        slopes[index] = np.abs(dot(normal, ways))
    return t, slopes
