"""Where a scene asks for more digits, or for more samples, than there are."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.fields import Length
from minirt.kernel.trace import ROUNDING
from minirt.lanes import Vec
from minirt.rendering.camera import camera_numbers
from minirt.rendering.notes import name
from minirt.rendering.pick import columns
from minirt.rendering.tables import Tables
from minirt.scene import Scene
from minirt.shapes import KINDS

DOUBLE, SINGLE = 2.0**-53, 2.0**-24  # unit roundoffs
WORTH_A_WORD = 1e-4  # of what is looked at: an error that large
LISTED = 10  # warnings of a sort, the worst first


class Stiff(NamedTuple):
    """A shape that is stiff, and by how much."""

    element: str
    why: str
    figures: dict[str, float]

    def __str__(self) -> str:
        figures = (f"{name} {value:.2g}" for name, value in self.figures.items())
        return f"{self.element}: {self.why} ({', '.join(figures)})"


class Views(NamedTuple):
    """How the eye and n shapes lie to each other, in scene units."""

    distance: np.ndarray  # (n,) from the eye to the surface
    size: np.ndarray  # (n,) the shortest length of each shape, infinity where it has none
    double: np.ndarray  # (n,) what rounding may do to a point on it
    single: np.ndarray  # (n,) the same in float32, relative to the eye
    ahead: np.ndarray  # (n,) whether the nearest point is before the camera


def stiff_shapes(scene: Scene, tables: Tables, width: int, height: int) -> Iterator[Stiff]:
    """What is stiff about the shapes of a scene, one by one, in a picture of that size."""
    camera = camera_numbers(scene.camera, width, height)
    seen = views(tables, camera)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.minimum(seen.size, seen.distance)
        double, single = seen.double / scale, seen.single / scale
        pixels = seen.size / (seen.distance * 2 * np.linalg.norm(camera[3:6]) / width)
    for index in worst(np.maximum(double, single), WORTH_A_WORD):
        small = seen.size[index] <= seen.distance[index]
        yield Stiff(
            name(tables, index),
            "small for its coordinates or its distance" if small else "the eye is close to it for its size",
            {
                "size": float(seen.size[index]),
                "distance": float(seen.distance[index]),
                "relative rounding of a hit, double": float(double[index]),
                "single": float(single[index]),
            },
        )
    for index in worst(np.where(seen.ahead & (pixels > 0), 1 / pixels, 0.0), 1.0):
        yield Stiff(
            name(tables, index),
            "thinner than a pixel, so samples may miss it",
            {"pixels": float(pixels[index])},
        )


def worst(amounts: np.ndarray, limit: float) -> list[int]:
    """The places of the largest amounts above a limit."""
    order = np.argsort(-amounts, kind="stable")[:LISTED]
    return [int(index) for index in order if amounts[index] > limit]


def views(tables: Tables, camera: np.ndarray) -> Views:
    """How the eye and the shapes in some tables lie to each other."""
    eye, forward = camera[:3], camera[9:]
    nearest, size = np.zeros((len(tables.shapes), 3)), np.full(len(tables.shapes), np.inf)
    for kind in KINDS:
        mine = [index for index, shape in enumerate(tables.shapes) if type(shape) is kind.element]
        if not mine:
            continue
        shapes = [tables.shapes[index] for index in mine]
        with np.errstate(all="ignore"):
            on, _ = kind.surface(columns([shape.pack() for shape in shapes]), Vec(*eye))
        nearest[mine] = np.stack([np.broadcast_to(part, len(mine)) for part in (on.x, on.y, on.z)], axis=-1)
        lengths = [each.name for each in fields_of(kind.element) if isinstance(each, Length)]
        if lengths:
            size[mine] = [min(getattr(shape, length) for length in lengths) for shape in shapes]
    nearest = np.where(np.isfinite(nearest), nearest, tables.boxes[:, :3])  # from the very middle no point is nearest
    way = nearest - eye
    reach = np.abs(tables.boxes[:, :3] - eye).max(axis=1) + tables.boxes[:, 3]  # of the shape, seen from the eye
    return Views(
        np.linalg.norm(way, axis=1),
        size,
        ROUNDING * DOUBLE * (np.abs(nearest).max(axis=1) + np.abs(eye).max() + tables.looks[:, 3]),
        ROUNDING * SINGLE * (np.abs(way).max(axis=1) + reach),
        way @ forward > 0,
    )
