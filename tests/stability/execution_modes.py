"""The execution modes of formulas: those of `tests.shapes.execution_modes`, and `minirt.trace`."""

from __future__ import annotations

import numpy as np

import minirt
from minirt.scene import Camera, Scene
from minirt.shapes import Shape
from tests.shapes.execution_modes import Array, Intersect, compiled, on_arrays, on_numbers

EVERY = 4  # on single numbers only every n-th ray is tried, as they take long


def few_on_numbers(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    return on_numbers(shapes, origins[:, ::EVERY], directions[:, ::EVERY])


def traced(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """t of rays by `minirt.trace`, each shape in a scene of its own."""
    eye = Camera((0, 0, 0), (0, 0, 1), 60)
    rays = zip(shapes, origins, directions, strict=True)
    return np.stack([minirt.trace(Scene((eye, shape)), o, d).distance for shape, o, d in rays])


MODES: dict[str, tuple[Intersect, int]] = {
    "arrays": (on_arrays, 1),
    "numbers": (few_on_numbers, EVERY),
    "compiled": (compiled, 1),
    "traced": (traced, 1),
}
