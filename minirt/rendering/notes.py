"""What was decided about a scene when it was packed, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from minirt.kernel.traced import Traced
from minirt.rendering.flats import same_side
from minirt.rendering.tables import Tables
from minirt.scene import Light, Scene
from minirt.shapes import ALL_KINDS, Shape


def notes(scene: Scene, tables: Tables, traced: Traced) -> Iterator[str]:
    """Sentences; lights and shapes have the numbers of their places among those of their kind in the file."""
    shapes = f"{len(tables.places)} shape{'s' * (len(tables.places) != 1)}"
    used = {type(shape) for shape in scene.shapes}
    yield f"kernel for {plurals(used)}"
    if idle_kinds := {kind.element for kind in ALL_KINDS} - used:
        yield f"kernel without {plurals(idle_kinds)}"
    sizes = sum(np.diff(group.starts) for group in traced.groups)
    yield f"tiles: {len(sizes)}, {np.mean(sizes):.1f} of {shapes} in each, {np.count_nonzero(sizes == 0)} without any"
    if traced.grid == 1:
        yield f"light buffer: none, every shape is tried ({shapes})"
    else:
        yield f"light buffer: 6 x {traced.grid} x {traced.grid} cells a lamp ({shapes})"
    for number, light in enumerate(scene.lights, 1):
        if not light.brightness:
            yield f"light {number} has brightness 0"
        elif not any(light.colour):
            yield f"light {number} is black"
        elif isinstance(light, Light):
            idle = same_side(tables.planes, np.array(scene.camera.position), np.array(light.position))
            for index in tables.flat[idle].tolist():
                yield f"{name(tables, index)} hides nothing from light {number}"


def plurals(elements: set[type[Shape]]) -> str:
    """What people call shapes of these kinds, in the order of the registry."""
    return ", ".join(kind.element.plural for kind in ALL_KINDS if kind.element in elements)


def name(tables: Tables, index: int) -> str:
    """What people call a shape: plane 2."""
    return f"{type(tables.shapes[tables.owner[index]]).title} {tables.places[index, 1] + 1}"
