"""Sentences about the decisions made for a packed scene: its kernel, tiles, light buffers and lights without effect."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from minirt.errors import counted
from minirt.rendering.packing.features import WORDS, features
from minirt.rendering.packing.lights import never_occludes
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Lamp, Scene
from minirt.scene.names import element_name
from minirt.shapes import ALL_KINDS, Shape

if TYPE_CHECKING:
    from minirt.kernel.scene_arrays import SceneArrays
    from minirt.rendering.packing.generic_kernels import GenericKernel

MOST_NAMED = 3  # shapes in a notice
NO_GENERIC_KERNEL = "no generic kernel: none was compiled ahead of time for these sources and this processor"


def notes(scene: Scene, shape_arrays: ShapeArrays, arrays: SceneArrays) -> Iterator[str]:
    """Describe how the shapes of a scene, of which it must have one, were packed: tiles, light buffers, and what has no
    effect."""
    shapes = counted(len(shape_arrays.listed), "shape")
    sizes = sum(np.diff(group.tile_starts) for group in arrays.groups)  # shapes of all groups in each tile, (tiles,)
    yield f"tiles: {len(sizes)}, {np.mean(sizes):.1f} of {shapes} in each, {np.count_nonzero(sizes == 0)} without any"
    if arrays.light_buffer_cells == 1:
        yield f"light buffer: none, every shape is tried ({shapes})"
    else:
        cells = arrays.light_buffer_cells
        yield f"light buffer: 6 x {cells} x {cells} cells per light ({shapes})"
    for number, light in enumerate(scene.lights):
        name = light_name(scene, number)
        if not light.brightness:
            yield f"{name} has brightness 0"
        elif not any(light.colour):
            yield f"{name} is black"
        else:
            harmless = never_occludes(shape_arrays, np.array(scene.camera.position), light)
            for index in shape_arrays.owner[shape_arrays.plane_indices[harmless]].tolist():
                yield f"{shape_name(scene, index)} hides nothing from {name}"


def kernel_notes(scene: Scene, generic: GenericKernel | None, compiling: bool, samples: object = None) -> Iterator[str]:
    """Describe the kernel that drew a scene: which one it is, and which kinds of shapes and features it leaves out.

    `generic` is the generic kernel that drew it, None if the specialised one did. `compiling`: whether the specialised
    one is being compiled meanwhile. `samples` are those of `features`.
    """
    used = {type(shape) for shape in scene.shapes}
    if generic:
        yield f"generic kernel for all kinds of shapes and {'all' if generic.name == 'full' else 'no'} features"
        if compiling:
            yield f"the kernel for {plurals(used)} alone is being compiled"
        return
    yield f"kernel for {plurals(used)}"
    if unused := {kind.element for kind in ALL_KINDS} - used:
        yield f"kernel without {plurals(unused)}"
    used_features = features(scene, samples)
    if unused_features := [words for feature, words in WORDS.items() if feature not in used_features]:
        yield f"kernel without {', '.join(unused_features)}"


def plurals(elements: set[type[Shape]]) -> str:
    """List the names of some kinds of shapes, in the order of the registry: spheres, planes."""
    return ", ".join(kind.element.plural for kind in ALL_KINDS if kind.element in elements)


def names_of(scene: Scene, indices: Sequence[int]) -> str:
    """Name the first of some shapes."""
    names = ", ".join(shape_name(scene, index) for index in indices[:MOST_NAMED])
    return f"{names}, ..." if len(indices) > MOST_NAMED else names


def shape_name(scene: Scene, index: int) -> str:
    """Name `scene.shapes[index]`."""
    return element_name(scene, next(islice(scene.indices_of(Shape), index, None)))


def light_name(scene: Scene, index: int) -> str:
    """Name `scene.lights[index]`."""
    return element_name(scene, next(islice(scene.indices_of(Lamp), index, None)))
