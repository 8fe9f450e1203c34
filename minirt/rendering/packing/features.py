"""Features of a scene: kinds of shapes, materials and lights, for which the kernel has code only where they are
used."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from operator import attrgetter
from typing import Any

from minirt.element import Element, fields_of
from minirt.materials import Attributes
from minirt.scene import Background, Lamp, Light, ParallelLight, Scene, SpotLight
from minirt.shapes import Shape

# By fields of `minirt.kernel.scene_arrays.SceneArrays` and `minirt.kernel.shading.texturing.SurfaceMaps`, in words.
FEATURES = {
    "specular": "highlights",
    "reflective": "mirrors and glass",
    "checks": "checkerboards",
    "textures": "textures",
    "bumps": "bumps",
    "normals": "maps of normals",
    "spots": "spots, parallel and fading light",
    "background": "a coloured background",
    "environment": "a picture as background",
}
DEPTH = 8  # reflections and refractions along a path, at most
MATERIALS = fields_of(Attributes)  # of every shape
ATTRIBUTES = attrgetter(*(field.name for field in MATERIALS))  # the values of these fields of a shape
PLAIN = (None,) * len(MATERIALS)  # the values of a shape without materials


def features(scene: Scene) -> frozenset[Hashable]:
    """The kinds of shapes in the scene, the keys of `FEATURES` that it uses, and "parallel" if a light is."""
    return frozenset().union(*(page.ask(features_of_items) for page in scene.pages))


def primitive_count(scene: Scene) -> int:
    """Number of primitives in the kernel: shapes, and the triangles of meshes."""
    return sum(page.ask(primitive_count_of_items) for page in scene.pages)


def primitive_count_of_items(items: Iterable[Element | str]) -> int:
    """Number of primitives of some elements."""
    return sum(item.parts for item in items if isinstance(item, Shape))


def features_of_items(items: Iterable[Element | str]) -> frozenset[Hashable]:
    """The features of some elements."""
    return frozenset().union(*map(features_of, items))


def features_of(item: Element | str) -> Iterable[Hashable]:
    """The features of one element."""
    if isinstance(item, Shape):
        kind: Any = type(item)
        return (kind,) if ATTRIBUTES(item) == PLAIN else (kind, *material_features(item))
    if isinstance(item, Lamp) and item.brightness and any(item.colour):
        if isinstance(item, ParallelLight):
            return "spots", "parallel"
        if isinstance(item, SpotLight) or (isinstance(item, Light) and item.fade is not None):
            return ("spots",)
    if isinstance(item, Background):
        return (("environment",) if isinstance(item.paint, str) else ("background",)) if any(item.paint) else ()
    return ()


def material_features(shape: Shape) -> Iterable[str]:
    """The features that the materials of a shape need."""
    values = zip(MATERIALS, ATTRIBUTES(shape), strict=True)
    return dict.fromkeys(filter(None, (field.feature_of(value) for field, value in values if value is not None)))
