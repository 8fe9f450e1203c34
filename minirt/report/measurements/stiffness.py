"""Where a scene asks for more digits, or for more samples, than there are."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from minirt.kernel.rows import kind_of
from minirt.kernel.trace import ROUNDING
from minirt.lanes import Vec
from minirt.rendering.notes import shape_name
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.pick import packed_columns
from minirt.rendering.scene_packing import Packing
from minirt.report.measurements.sizes import sizes
from minirt.scene import Scene

DOUBLE, SINGLE = 2.0**-53, 2.0**-24  # unit roundoffs
VISIBLE = 1 / 255  # of what is looked at: an error that turns surfaces by so much changes a level of a colour
LISTED = 3  # shapes that are named, the worst first; the others are counted


class Stiff(NamedTuple):
    """A shape that is stiff, and by how much."""

    element: str
    why: str
    figures: dict[str, float]

    def __str__(self) -> str:
        figures = ", ".join(f"{name} {value:.2g}" for name, value in self.figures.items())
        return f"{self.element}: {self.why} ({figures})"


class Views(NamedTuple):
    """How the eye and n parts of shapes lie to each other, in scene units."""

    distance: np.ndarray  # (n,) from the eye to the surface
    size: np.ndarray  # (n,) the shortest length of each shape, infinity where it has none
    double: np.ndarray  # (n,) what rounding may do to a point on it
    single: np.ndarray  # (n,) the same in float32, relative to the eye
    ahead: np.ndarray  # (n,) whether the nearest point is before the camera


def stiff_shapes(scene: Scene, tables: ShapeArrays, width: int, height: int) -> Iterator[Stiff]:
    """What is stiff about the shapes of a scene, one by one, in a picture of that size."""
    camera = camera_numbers(scene.camera, width, height)
    seen = views(tables, camera)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.minimum(seen.size, seen.distance)
        double, single = seen.double / scale, seen.single / scale
        pixels = seen.size / (seen.distance * 2 * np.linalg.norm(camera[3:6]) / width)
    for index, element in worst(tables, np.maximum(double, single), VISIBLE):
        small = seen.size[index] <= seen.distance[index]
        yield Stiff(
            element,
            "small for its coordinates or its distance" if small else "the eye is close to it for its size",
            {
                "size": float(seen.size[index]),
                "distance": float(seen.distance[index]),
                "relative rounding of a hit, double": float(double[index]),
                "single": float(single[index]),
            },
        )
    thinness = np.where(seen.ahead & (pixels > 0), 1 / pixels, 0.0)
    for index, element in worst(tables, thinness, 1.0):
        yield Stiff(element, "thinner than a pixel, so samples may miss it", {"pixels": float(pixels[index])})


def lost_in_single(scene: Scene, packing: Packing, width: int, height: int) -> Iterator[Stiff]:
    """What looks otherwise than it should in a picture that was made of a scene in float32."""
    if scene.shapes and packing.pack(scene, width, height).camera.dtype == np.float32:
        for each in stiff_shapes(scene, packing.shape_arrays, width, height):
            if each.figures.get("single", 0.0) > VISIBLE:
                yield each


def worst(tables: ShapeArrays, amounts: np.ndarray, limit: float) -> Iterator[tuple[int, str]]:
    """The shapes with the largest amounts above a limit: indices and names, the last one with how many more there
    are."""
    order = np.argsort(-amounts, kind="stable")
    order = order[amounts[order] > limit]
    _, first = np.unique(tables.owner[order], return_index=True)
    order = order[np.sort(first)]  # of each shape the worst part
    more = len(order) - LISTED
    for place, index in enumerate(order[:LISTED].tolist(), 1):
        yield index, shape_name(tables, index) + (f" and {more} more" if more > 0 and place == LISTED else "")


def views(tables: ShapeArrays, camera: np.ndarray) -> Views:
    """How the eye and the shapes in some tables lie to each other."""
    eye, forward = camera[:3], camera[9:]
    nearest, size = np.zeros((len(tables.owner), 3)), np.full(len(tables.owner), np.inf)
    for group, packed in enumerate(tables.rows):
        mine = np.flatnonzero(tables.slots[:, 0] == group)
        with np.errstate(all="ignore"):
            on, _ = kind_of(packed.dtype.names).surface(packed_columns(packed), Vec(*eye))
        nearest[mine] = np.stack([np.broadcast_to(part, len(mine)) for part in (on.x, on.y, on.z)], axis=-1)
        if not tables.is_plane[group]:  # one with an end is in its box, not everywhere on the plane that it lies in
            middle, half = tables.boxes[mine, :3], tables.boxes[mine, 3:]
            nearest[mine] = np.clip(nearest[mine], middle - half, middle + half)
        owners, part_of = np.unique(tables.owner[mine], return_inverse=True)
        size[mine] = sizes([tables.shapes[i] for i in owners]).min(axis=1, initial=np.inf)[part_of]
    nearest = np.where(np.isfinite(nearest), nearest, tables.boxes[:, :3])  # from the very middle no point is nearest
    way = nearest - eye
    reach = np.abs(tables.boxes[:, :3] - eye).max(axis=1) + tables.boxes[:, 3]  # of the shape, seen from the eye
    return Views(
        np.linalg.norm(way, axis=1),
        size,
        ROUNDING * DOUBLE * (np.abs(nearest).max(axis=1) + np.abs(eye).max() + tables.colours_and_extents[:, 3]),
        ROUNDING * SINGLE * (np.abs(way).max(axis=1) + reach),
        way @ forward > 0,
    )
