"""Features of a scene: the shapes, materials and lights that its kernel is compiled for."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from operator import attrgetter
from typing import Any

from minirt.element import Element, fields_of
from minirt.materials import Attributes
from minirt.materials.compound import Material
from minirt.scene import Background, Camera, Lamp, Light, ParallelLight, Scene, SpotLight
from minirt.shapes import Shape

# The names of features in words, by the field of `minirt.kernel.scene_arrays` or `minirt.kernel.shading.texturing`.
FEATURES = {
    "specular": "highlights",
    "reflective": "mirrors and glass",
    "media": "tinted glass",
    "fresnel": "Fresnel's equations",
    "glow": "glow",
    "checks": "checkerboards",
    "textures": "textures",
    "bumps": "bumps",
    "normals": "maps of normals",
    "placements": "scaled and turned maps",
    "patterns": "marble, wood and clouds",
    "raised_patterns": "raised patterns",
    "soft": "lights with a size",
    "lens": "a lens",
    "spots": "spots, parallel and fading light",
    "background": "a coloured background",
    "environment": "a picture as background",
}
NEEDS = {"media": "transparent", "fresnel": "reflective"}  # features without effect where a shape lacks the other one
COORDINATE_MAPS = frozenset({"checks", "textures", "bumps", "normals"})  # features that look up u and v
SECONDARY = frozenset({"reflective", "transparent", "media", "fresnel", "fades"})  # features of secondary rays
SPREAD = frozenset({"parallel", "soft"})  # features of light sources that are not points: shadow rays share no end
DEPTH = 8  # reflections and refractions of a ray, at most
MATERIALS = tuple((field.name, field) for field in fields_of(Attributes))
ATTRIBUTES = attrgetter(*(name for name, _ in MATERIALS))
PLAIN = (None,) * len(MATERIALS)


def features(scene: Scene) -> frozenset[Hashable]:
    """The kinds of shapes in a scene, and the keys of `FEATURES` that it uses.

    Of these "parallel", "transparent", "fades" and "smooth" are parts: parallel light, glass, fading reflections, and
    smooth meshes.
    """
    return frozenset().union(*(page.cached(features_of_items) for page in scene.pages))


def primitive_count(scene: Scene) -> int:
    """Count the primitives of a scene: its shapes, and for each mesh its triangles."""
    return sum(page.cached(primitive_count_of_items) for page in scene.pages)


def primitive_count_of_items(items: Iterable[Element | str]) -> int:
    """Count the primitives of some elements."""
    return sum(item.parts for item in items if isinstance(item, Shape))


def features_of_items(items: Iterable[Element | str]) -> frozenset[Hashable]:
    """The features that some elements use."""
    return frozenset().union(*map(features_of, items))


def features_of(item: Element | str) -> Iterable[Hashable]:
    """The features that an element uses, with repetitions."""
    if isinstance(item, Shape):
        kind: Any = type(item)
        plain = ATTRIBUTES(item) == PLAIN and not item.smooth
        return (kind,) if plain else (kind, *shape_features(item))
    if isinstance(item, Lamp) and item.brightness and any(item.colour):
        return light_features(item)
    if isinstance(item, Camera) and item.lens:
        return ("lens",)
    if isinstance(item, Background):
        return (("environment",) if isinstance(item.paint, str) else ("background",)) if any(item.paint) else ()
    return ()


def light_features(light: Lamp) -> Iterable[str]:
    """The features that a light needs."""
    soft = ("soft",) if light.size else ()
    if isinstance(light, ParallelLight):
        return "spots", "parallel", *soft
    if isinstance(light, SpotLight) or (isinstance(light, Light) and light.fade is not None):
        return "spots", *soft
    return soft


def shape_features(shape: Shape) -> Iterable[str]:
    """The features that a shape needs for itself and for its materials."""
    return ("smooth", *material_features(shape)) if shape.smooth else material_features(shape)


def material_features(shape: Shape) -> Iterable[str]:
    """The features that the materials of a shape need."""
    values = [
        (field, value) for (_, field), value in zip(MATERIALS, ATTRIBUTES(shape), strict=True) if value is not None
    ]
    found = dict.fromkeys(filter(None, (field.feature_of(value) for field, value in values)))
    for _, value in values:
        if isinstance(value, Material) and value.has_effect():
            found.update(dict.fromkeys(value.further_features()))
    if not COORDINATE_MAPS.isdisjoint(found) and shape.map_frame():
        found["placements"] = None
    return [feature for feature in found if NEEDS.get(feature, feature) in found]
