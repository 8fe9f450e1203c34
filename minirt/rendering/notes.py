"""What was decided about a scene when it was packed, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from minirt.kernel.culling.light_buffer import FRUSTUM_FACTOR, SCALE
from minirt.kernel.scene_arrays import SceneArrays
from minirt.rendering.culling.planes import never_occludes
from minirt.rendering.packing.features import FEATURES, features
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Scene
from minirt.shapes import ALL_KINDS, Shape


def notes(scene: Scene, tables: ShapeArrays, traced: SceneArrays) -> Iterator[str]:
    """Sentences; lights and shapes have the numbers of their places among those of their kind in the file."""
    shapes = f"{len(tables.slots)} shape{'s' * (len(tables.slots) != 1)}"
    used = {type(shape) for shape in scene.shapes}
    yield f"kernel for {plurals(used)}"
    if idle_kinds := {kind.element for kind in ALL_KINDS} - used:
        yield f"kernel without {plurals(idle_kinds)}"
    needed = features(scene)
    yield f"kernel without {', '.join(words for feature, words in FEATURES.items() if feature not in needed)}"
    sizes = sum(np.diff(group.tile_starts) for group in traced.groups)
    yield f"tiles: {len(sizes)}, {np.mean(sizes):.1f} of {shapes} in each, {np.count_nonzero(sizes == 0)} without any"
    if traced.light_buffer_cells == 1:
        yield f"light buffer: none, every shape is tried ({shapes})"
    else:
        yield f"light buffer: {' or '.join(cells(traced))} a lamp ({shapes})"
    for number, light in enumerate(scene.lights, 1):
        if not light.brightness:
            yield f"light {number} has brightness 0"
        elif not any(light.colour):
            yield f"light {number} is black"
        else:
            for index in tables.flat[never_occludes(tables, np.array(scene.camera.position), light)].tolist():
                yield f"{name(tables, index)} hides nothing from light {number}"


def cells(traced: SceneArrays) -> Iterator[str]:
    """What cells lamps have: around them, or ahead of them where they see all shapes there."""
    ahead, edge = traced.light_buffers[:, SCALE] > 0, FRUSTUM_FACTOR * traced.light_buffer_cells
    if not ahead.all() or not len(ahead):
        yield f"6 x {traced.light_buffer_cells} x {traced.light_buffer_cells} cells"
    if ahead.any():
        yield f"{edge} x {edge} cells ahead of"


def plurals(elements: set[type[Shape]]) -> str:
    """What people call shapes of these kinds, in the order of the registry."""
    return ", ".join(kind.element.plural for kind in ALL_KINDS if kind.element in elements)


def name(tables: ShapeArrays, index: int) -> str:
    """What people call a shape, or that of which it is a part: plane 2."""
    owner = int(tables.owner[index])
    kind = type(tables.shapes[owner])
    return f"{kind.title} {sum(type(shape) is kind for shape in tables.shapes[: owner + 1])}"
