"""Features and kinds of shapes that a scene has, and that no pixel of its picture can show."""

from __future__ import annotations

from collections.abc import Hashable, Iterator

import numpy as np

from minirt.element import Element, fields_of
from minirt.materials import Attributes
from minirt.rendering.packing.features import ATTRIBUTES, FEATURES, PLAIN, features, material_features
from minirt.rendering.scene_packing import Packing
from minirt.report.measurements.variants import Variant
from minirt.scene import Scene
from minirt.shapes import Shape


def without_unseen(scene: Scene, width: int, height: int) -> Iterator[Variant]:
    """Yield the scene without each material and each kind of shape that does nothing for its picture.

    The lists for culling tell what can be seen: they may hold too much, never too little. Where a mirror or glass can
    be seen, every shape counts as seen.
    """
    seen, lit = shapes_in_lists(scene, width, height)
    used = {feature for shape in seen for feature in material_features(shape)}
    if "reflective" in used:
        return
    materials = {feature for shape in scene.shapes for feature in material_features(shape)}
    for feature, words in FEATURES.items():
        if feature in materials - used:
            yield Variant("unseen", words, "without", Scene(stripped(scene, feature), scene.file))
    if "parallel" in features(scene):  # whose shadow rays need no list
        return
    for kind in {type(shape): None for shape in scene.shapes}:
        if kind not in {type(shape) for shape in (*seen, *lit)}:
            kept = Scene((each for each in scene.elements if type(each) is not kind), scene.file)
            if kept.shapes:
                yield Variant("unseen", kind.plural, "without", kept)


def shapes_in_lists(scene: Scene, width: int, height: int) -> tuple[list[Shape], list[Shape]]:
    """Return the shapes in the list of any tile, and those in the list of any light-buffer cell."""
    packing = Packing()
    arrays = packing.pack(scene, width, height)
    owner = packing.shape_arrays.owner
    lists = (np.unique(owner[np.unique(each)]).tolist() for each in (arrays.tile_shapes, arrays.light_shapes))
    seen, lit = ([scene.shapes[index] for index in each] for each in lists)
    return seen, lit


def stripped(scene: Scene, feature: Hashable) -> Iterator[Element]:
    """Yield the elements of a scene, without the materials that need a feature."""
    for each in scene.elements:
        if isinstance(each, Shape) and ATTRIBUTES(each) != PLAIN:
            values = {field.name: (field, getattr(each, field.name)) for field in fields_of(Attributes)}
            names = [name for name, (field, value) in values.items() if value and field.feature_of(value) == feature]
            yield each.replace(**dict.fromkeys(names))
        else:
            yield each
