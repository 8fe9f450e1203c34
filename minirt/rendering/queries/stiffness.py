"""Stiff parts of a scene: shapes that need more digits or more samples than the renderer has, and close surfaces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Length, Lengths, Point
from minirt.kernel.scene_arrays import kind_of
from minirt.kernel.trace import ROUNDING
from minirt.lanes import Vec, dot
from minirt.rendering.notes import shape_name
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.packed_shapes import bounding_boxes, extents_from
from minirt.rendering.packing.ray_casting import camera_ray, packed_columns
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene
from minirt.shapes import Mesh, Shape


def defining_lengths(shapes: Sequence[Shape]) -> NDArray[np.float64]:
    """Return the lengths that define each of n shapes of one type, and the distances between its points, (n, k).

    A plane has none; a mesh has the diagonal of its bounding box.
    """
    if isinstance(shapes[0], Mesh):
        diagonals: NDArray[np.float64] = np.linalg.norm(np.diff(bounding_boxes(list(shapes)), axis=1)[:, 0], axis=1)
        return diagonals[:, None]

    def columns(*sorts: type) -> list[NDArray[np.float64]]:
        names = [each.name for each in fields_of(type(shapes[0])) if isinstance(each, sorts) and each.required]
        return [np.array([getattr(shape, name) for shape in shapes], float).reshape(len(shapes), -1) for name in names]

    points = columns(Point)
    # From each point to the one before, from the first to the last.
    sides = [np.linalg.norm(one - points[i - 1], axis=1, keepdims=True) for i, one in enumerate(points)]
    return np.hstack([*columns(Length, Lengths), *(sides if len(points) > 1 else ())] or [np.zeros((len(shapes), 0))])


DOUBLE, SINGLE = 2.0**-53, 2.0**-24  # unit roundoffs
LEAST_IN_SINGLE = 2.0**-60  # scene units; squares of smaller numbers leave the range of float32
VISIBLE = 1 / 255  # relative error of a hit that turns a normal enough to change a level of a colour
LISTED = 3  # shapes that are named, the worst first; the rest is counted


class Stiff(NamedTuple):
    """A stiff shape, the reason, and the figures that show it."""

    element: str
    why: str
    figures: dict[str, float]

    def __str__(self) -> str:
        figures = ", ".join(f"{name} {value:.2g}" for name, value in self.figures.items())
        return f"{self.element}: {self.why} ({figures})"


def stiff_shapes(scene: Scene, tables: ShapeArrays, width: int, height: int) -> Iterator[Stiff]:
    """Yield the stiff shapes of a scene, packed in `tables`, in a picture of the given size: those whose hits rounding
    may spoil, then those thinner than a pixel."""
    eye, right, _, forward = camera_numbers(scene.camera, width, height).reshape(4, 3)
    boxes, extents = tables.primitive_boxes()
    nearest, size = nearest_points_and_sizes(tables, eye, boxes)
    way = nearest - eye
    distance = np.linalg.norm(way, axis=1)
    # Rounding errors of a point on the surface, in scene units; in float32 relative to the eye.
    double_error = ROUNDING * DOUBLE * (np.abs(nearest).max(axis=1) + np.abs(eye).max() + extents)
    single_error = ROUNDING * SINGLE * (np.abs(way).max(axis=1) + extents_from(eye, boxes))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        scale = np.minimum(size, distance)
        double, single = double_error / scale, np.where(scale < LEAST_IN_SINGLE, np.inf, single_error / scale)
        pixels = size / (distance * 2 * np.linalg.norm(right) / width)
        thinness = np.where((way @ forward > 0) & (pixels > 0), 1 / pixels, 0.0)
    figures = {"size": size, "distance": distance, "relative rounding of a hit, double": double, "single": single}
    for index, element in worst(scene, tables, np.maximum(double, single), VISIBLE):
        small = size[index] <= distance[index]
        why = "small for its coordinates or its distance" if small else "the eye is close to it for its size"
        yield Stiff(element, why, {name: float(each[index]) for name, each in figures.items()})
    for index, element in worst(scene, tables, thinness, 1.0):
        yield Stiff(element, "thinner than a pixel, so samples may miss it", {"pixels": float(pixels[index])})


def lost_in_single(scene: Scene, packing: Packing, width: int, height: int) -> Iterator[Stiff]:
    """Yield the shapes that look wrong in a picture that was rendered in float32, and the pairs of surfaces that only
    float32 takes for one."""
    if scene.shapes and packing.pack(scene, width, height, samples=packing.samples).camera.dtype == np.float32:
        for each in stiff_shapes(scene, packing.shape_arrays, width, height):
            if each.figures.get("single", 0.0) > VISIBLE:
                yield each
        for each in coincident(scene, packing.shape_arrays, *FEW):
            if each.figures["in roundings, single"] <= 1 < each.figures["in roundings, double"]:
                yield each


def worst(scene: Scene, tables: ShapeArrays, amounts: np.ndarray, limit: float) -> Iterator[tuple[int, str]]:
    """Yield index and name of the shapes with the largest amounts above a limit; the last name counts the rest."""
    order = np.argsort(-amounts, kind="stable")
    order = order[amounts[order] > limit]
    _, first = np.unique(tables.owner[order], return_index=True)
    order = order[np.sort(first)]  # the worst primitive of each shape
    more = len(order) - LISTED
    for place, index in enumerate(order[:LISTED].tolist(), 1):
        name = shape_name(scene, tables.owner[index])
        yield index, name + (f" and {more} more" if more > 0 and place == LISTED else "")


def nearest_points_and_sizes(tables: ShapeArrays, eye: np.ndarray, boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return for each of n primitives, which lie in `boxes` (n, 2, 3), its point nearest to the eye, (n, 3), and the
    shortest length that defines its shape, (n,), infinity if there is none."""
    nearest, size = np.zeros((len(tables.owner), 3)), np.full(len(tables.owner), np.inf)
    for group, packed in enumerate(tables.rows):
        selected = tables.primitives_of(group)
        with np.errstate(all="ignore"):
            on, _ = kind_of(packed.dtype.names).surface(packed_columns(packed), Vec(*eye))
        nearest[selected] = np.stack([np.broadcast_to(part, len(selected)) for part in (on.x, on.y, on.z)], axis=-1)
        if not tables.is_plane[group]:  # a bounded shape lies within its box, not everywhere on its surface's extension
            nearest[selected] = np.clip(nearest[selected], *boxes[selected].swapaxes(0, 1))
        owners, part_of = np.unique(tables.owner[selected], return_inverse=True)
        size[selected] = defining_lengths([tables.shapes[i] for i in owners]).min(axis=1, initial=np.inf)[part_of]
    # At the exact centre no point is nearest.
    return np.where(np.isfinite(nearest), nearest, boxes.mean(axis=1)), size


# Find coincident surfaces: pairs so close together that rounding decides which of them is seen (z-fighting).

ACROSS, DOWN = 64, 36  # test rays over the whole picture
FEW = 16, 9  # of a notice, which takes a sixteenth of the time
LEAST = 4  # test rays that must show two close surfaces: where surfaces cross, a ray may do so by chance
MOST_SHAPES = 1000  # shapes or mesh triangles; larger scenes are not tested
TIE = 4 * ROUNDING  # unit roundoffs up to which `minirt.kernel.trace.closer_hit` takes two surfaces for one
CLOSE = 1000  # times TIE: surfaces that nearly coincide


def coincident(scene: Scene, tables: ShapeArrays, across: int = ACROSS, down: int = DOWN) -> Iterator[Stiff]:
    """Yield the pairs of shapes whose surfaces coincide, or nearly coincide, as seen from the eye by `across` times
    `down` rays. Nothing is yielded for more than MOST_SHAPES primitives."""
    if not 2 <= len(tables.owner) <= MOST_SHAPES:
        return
    y, x = np.mgrid[:down, :across].reshape(2, -1) + 0.5
    origin, ways = camera_ray(scene.camera, across, down, x, y)
    eye = np.array(scene.camera.position, np.float64)
    with np.errstate(all="ignore"):
        t, slopes = all_hits(tables, origin, ways)
        pair = np.argsort(t, axis=0, kind="stable")[:2]  # the two nearest primitives on each ray
        near, far = np.take_along_axis(t, pair, axis=0)
        gap = (far - near) * np.take_along_axis(slopes, pair[:1], axis=0)[0]  # between the surfaces
        points = near * np.stack([ways.x, ways.y, ways.z])
        boxes, extents = tables.primitive_boxes()
        reach = extents_from(eye, boxes)
        world = np.abs(points + eye[:, None]).max(axis=0) + np.abs(eye).max()
        double = gap / (TIE * DOUBLE * (world + extents[pair].max(axis=0)))
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
                " and ".join(shape_name(scene, owner) for owner in tables.owner[[one, other]]),
                f"taken for one surface in {shared} precision: the first is shown" if shared else "nearly coincide",
                {"share of the picture": count / t.shape[1], "gap": float(np.median(gap[selected]))}
                | {f"in roundings, {precision}": gaps for precision, gaps in ties.items()},
            )


def all_hits(tables: ShapeArrays, eye: Vec, ways: Vec) -> tuple[np.ndarray, np.ndarray]:
    """For each shape and ray return the hit distance, infinity for a miss, and the cosine of ray and normal."""
    t, slopes = np.empty((2, len(tables.owner), len(ways.x)))
    for group, rows in enumerate(tables.rows):
        selected, packed, kind = tables.primitives_of(group), packed_columns(rows, 1), kind_of(rows.dtype.names)
        hit, at = kind.intersect(packed, eye, ways)
        _, normal = kind.surface(packed, eye + at * ways)
        t[selected], slopes[selected] = np.where(hit, at, np.inf), np.abs(dot(normal, ways))
    return t, slopes
