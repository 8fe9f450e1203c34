"""What a scene asks of the kernel: kinds of shapes, and features that are compiled only where they are used."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from operator import attrgetter
from typing import Any

from minirt.element import Element
from minirt.scene import Background, Lamp, Light, ParallelLight, Scene, SpotLight
from minirt.shapes import Shape

# In words, each with the fields of `minirt.kernel.scene_arrays` or `minirt.kernel.shading.texturing` that it stands for.
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
DEPTH = 8  # how often light is mirrored or refracted on its way, at most
ATTRIBUTES = attrgetter("specular", "mirror", "glass", "checker", "texture", "bump", "normal_map")
PLAIN = (None,) * 7


def features(scene: Scene) -> frozenset[Hashable]:
    """The kinds of shapes in the scene, "parallel" where a lamp is, and the keys of `FEATURES` that it uses."""
    return frozenset().union(*(page.cached(features_of_items) for page in scene.pages))


def primitive_count(scene: Scene) -> int:
    """How many things the kernel knows: shapes, of meshes the triangles."""
    return sum(page.cached(primitive_count_of_items) for page in scene.pages)


def primitive_count_of_items(items: Iterable[Element | str]) -> int:
    """Those of some elements."""
    return sum(item.parts for item in items if isinstance(item, Shape))


def features_of_items(items: Iterable[Element | str]) -> frozenset[Hashable]:
    """Those of some elements."""
    return frozenset().union(*map(features_of, items))


def features_of(item: Element | str) -> Iterable[Hashable]:
    """Those of an element."""
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
    """The features that a shape uses."""
    if shape.specular and shape.specular.share:
        yield "specular"
    if shape.mirror or (shape.glass and shape.glass.share):
        yield "reflective"
    if shape.checker:
        yield "checks"
    if shape.texture:
        yield "textures"
    if shape.bump and shape.bump.strength:
        yield "bumps"
    if shape.normal_map:
        yield "normals"
