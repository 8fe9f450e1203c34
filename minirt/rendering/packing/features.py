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
    "gloss": "highlights",
    "bounces": "mirrors and glass",
    "checks": "checkerboards",
    "textures": "textures",
    "bumps": "bumps",
    "normals": "maps of normals",
    "beams": "spots, parallel and fading light",
    "sky": "a coloured background",
    "dome": "a picture as background",
}
DEPTH = 8  # how often light is mirrored or refracted on its way, at most
ATTRIBUTES = attrgetter("specular", "mirror", "glass", "checker", "texture", "bump", "normal_map")
PLAIN = (None,) * 7


def traits(scene: Scene) -> frozenset[Hashable]:
    """The kinds of shapes in the scene, "parallel" where a lamp is, and the keys of `FEATURES` that it uses."""
    return frozenset().union(*(page.ask(traits_of_all) for page in scene.pages))


def parts(scene: Scene) -> int:
    """How many things the kernel knows: shapes, of meshes the triangles."""
    return sum(page.ask(parts_of_all) for page in scene.pages)


def parts_of_all(items: Iterable[Element | str]) -> int:
    """Those of some elements."""
    return sum(item.parts for item in items if isinstance(item, Shape))


def traits_of_all(items: Iterable[Element | str]) -> frozenset[Hashable]:
    """Those of some elements."""
    return frozenset().union(*map(traits_of, items))


def traits_of(item: Element | str) -> Iterable[Hashable]:
    """Those of an element."""
    if isinstance(item, Shape):
        kind: Any = type(item)
        return (kind,) if ATTRIBUTES(item) == PLAIN else (kind, *dressed(item))
    if isinstance(item, Lamp) and item.brightness and any(item.colour):
        if isinstance(item, ParallelLight):
            return "beams", "parallel"
        if isinstance(item, SpotLight) or (isinstance(item, Light) and item.fade is not None):
            return ("beams",)
    if isinstance(item, Background):
        return (("dome",) if isinstance(item.paint, str) else ("sky",)) if any(item.paint) else ()
    return ()


def dressed(shape: Shape) -> Iterable[str]:
    """The features that a shape uses."""
    if shape.specular and shape.specular.share:
        yield "gloss"
    if shape.mirror or (shape.glass and shape.glass.share):
        yield "bounces"
    if shape.checker:
        yield "checks"
    if shape.texture:
        yield "textures"
    if shape.bump and shape.bump.strength:
        yield "bumps"
    if shape.normal_map:
        yield "normals"
