"""Variants of a scene for the ablation: with a feature or a kind of shape that it lacks, or without a list.

What is added stands where no ray meets it, so that the picture stays the same: behind the eye and all lights.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from itertools import cycle
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from minirt.element import Element, fields_of
from minirt.fields import Direction, Length, Lengths, MeshField, Picture, Point
from minirt.kernel.scene_arrays import SHAPE
from minirt.materials import Attributes, Clouds, Compound
from minirt.rendering.image import Image
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.features import APERTURES, ATTRIBUTES, NO_MATERIALS, WORDS, features, material_features
from minirt.rendering.scene_packing import BOXES, LIGHT_BUFFERS, TILES, Packing
from minirt.scene import Background, Scene, SpotLight
from minirt.shapes import ALL_KINDS, Shape

SIZE = 1e-3  # of an added shape, as a share of the distance to it
DARK = (0, 0, 1)  # of an added background, which may be seen: the least that is not black
CULLING = "culling"  # name of the variant without any list
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


class Variant(NamedTuple):
    """A scene with something added, or the same scene packed without something that culls."""

    sort: str
    name: str
    change: str
    scene: Scene
    without: tuple[str, ...] = ()  # as of `minirt.rendering.scene_packing.Packing`


def without_lists(scene: Scene) -> Iterator[Variant]:
    """Yield the scene packed without each list that it has, and without all, so that every ray tries every shape. Such
    variants need no kernel of their own."""
    yield Variant("list", "tiles and their cones", "without", scene, (TILES,))
    if scene.lights:
        yield Variant("list", "light buffers and their cones", "without", scene, (LIGHT_BUFFERS,))
    if features(scene) & {"reflective", "parallel"}:
        yield Variant("list", "boxes of the BVH", "without", scene, (BOXES,))
    yield Variant("list", CULLING, "without", scene, (TILES, LIGHT_BUFFERS, BOXES))


def with_more(scene: Scene, folder: Path) -> Iterator[Variant]:
    """Yield the scene with each feature, then with each kind of shape, that it lacks; files are put into a folder.
    Features that one sample does not need, with which parts are measured, cost it nothing."""
    used, invisible = features(scene) | APERTURES, InvisibleElements(scene, folder)
    plain = invisible.record(type(scene.shapes[0]))
    for feature, added in invisible.features(plain).items():
        if feature not in used:
            yield Variant("feature", WORDS[feature], "added", with_element(scene, added))
    for kind in ALL_KINDS:
        if kind.element not in set(map(type, scene.shapes)):
            shape = invisible.record(kind.element)
            yield Variant("kind", kind.element.plural, "added", with_element(scene, shape))


def with_element(scene: Scene, added: Any) -> Scene:
    """Return a scene with an element more; a background replaces that of the scene."""
    return scene.remove(*scene.of(Background) if isinstance(added, Background) else ()).add(added)


class InvisibleElements:
    """Makes small elements at a place that no ray of a scene meets."""

    def __init__(self, scene: Scene, folder: Path) -> None:
        eye, _, _, forward = camera_numbers(scene.camera, 16, 9).reshape(4, 3)
        forward = forward / np.linalg.norm(forward)
        lights = [np.subtract(light.position, eye) for light in scene.lights if light.position]
        behind = max([1.0, *(-2 * float(offset @ forward) for offset in lights)])
        self.place, self.size = eye - behind * forward, SIZE * behind
        self.corners = cycle(np.vstack([np.zeros(3), np.eye(3)]) * self.size + self.place)
        self.back = (-forward).tolist()
        self.picture, self.mesh = str(folder / "grey.png"), str(folder / "tetrahedron.obj")
        Image(np.full((2, 2, 3), 128, np.uint8)).save(self.picture)
        Path(self.mesh).write_text(TETRAHEDRON)

    def features(self, plain: Shape) -> dict[str, Any]:
        """Return an element with each feature, by the feature's key; materials are those of a `plain` shape."""
        found: dict[str, Any] = {}
        fields = {field.name: field for field in fields_of(Attributes)}
        for name, field in fields.items():
            values = {each: self.value(fields[each]) for each in (name, *field.facts.needs[:1])}
            found.setdefault(field.features_of(values[name])[0], plain.replace(**values))
        found["raised_patterns"] = plain.replace(clouds=Clouds(self.size, height=0.1))
        found["spots"] = SpotLight(position=self.place, direction=self.back, angle=10.0, brightness=0.5)
        found |= {"background": Background(DARK), "environment": Background(self.picture)}
        return {feature: found[feature] for feature in WORDS if feature in found}

    def record(self, kind: type[Any]) -> Any:
        """Make a record of its required fields; its points are corners of a small tetrahedron."""
        return kind(**{field.name: self.value(field) for field in fields_of(kind) if field.required})

    def value(self, field: Any) -> Any:
        """Return a value of a field for an element that nobody sees.

        Sizes are small, points are corners of a small tetrahedron in turn, directions point backwards; others have the
        initial value of the field, or the middle of its range.
        """
        match field:
            case Compound():  # `bare`: the text for which the name of the field alone stands
                value = field.check(field.parse(field.bare)) if field.bare else self.record(field.record)
            case MeshField():
                value = field.check(field.parse(self.mesh))
            case Picture():
                value = self.picture
            case Lengths() if field.unit:  # in scene units; without a unit, it is a share
                value = (self.size,) * 3
            case Length() if field.unit:
                value = self.size * (field.initial or 1.0)  # an initial length is a factor of the usual one
            case Point():
                value = next(self.corners)
            case Direction():
                value = self.back
            case _:
                value = (field.low + field.high) / 2 if field.initial is None else field.initial
        return value


# Features and kinds of shapes that a scene has, and that no pixel of its picture can show.


def without_unseen(scene: Scene, width: int, height: int) -> Iterator[Variant]:
    """Yield the scene without each material and each kind of shape that does nothing for its picture.

    The lists for culling tell what can be seen: they may hold too much, never too little. Where a mirror or glass can
    be seen nothing is yielded. Glass that a light can see counts as used: its shadow may be seen.
    """
    packing = Packing()
    arrays = packing.pack(scene, width, height)
    in_tiles = arrays.tile_shapes[: arrays.groups[-1].tile_starts[-1]]  # behind those is room to spare
    listed = arrays.listed[:, SHAPE]  # the index of each shape in the lists
    seen, lit = (
        [scene.shapes[index] for index in listed[np.unique(each)].tolist()] for each in (in_tiles, arrays.light_shapes)
    )
    used = {feature for shape in seen for feature in material_features(shape)}
    casts_light = {feature for shape in lit if shape.glass for feature in material_features(shape)}
    if "reflective" in used:
        return
    materials = {feature for shape in scene.shapes for feature in material_features(shape)}
    for feature, words in WORDS.items():
        if feature in materials - used - casts_light:
            kept = (without_material(each, feature) for each in scene.elements)
            yield Variant("unseen", words, "without", Scene(kept, scene.file))
    if "parallel" in features(scene):  # whose shadow rays need no list
        return
    for kind in {type(shape): None for shape in scene.shapes}:
        rest = Scene((each for each in scene.elements if type(each) is not kind), scene.file)
        if rest.shapes and kind not in set(map(type, (*seen, *lit))):
            yield Variant("unseen", kind.plural, "without", rest)


def without_material(element: Element, feature: Hashable) -> Element:
    """Return an element without the materials of a feature."""
    if not isinstance(element, Shape) or ATTRIBUTES(element) == NO_MATERIALS:
        return element
    values = ((field, getattr(element, field.name)) for field in fields_of(Attributes))
    gone = [field.name for field, value in values if value and feature in field.features_of(value)[:1]]
    return element.replace(**dict.fromkeys(gone))
