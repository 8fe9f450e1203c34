"""Variants of a scene for the ablation: with a feature or a kind of shape that it lacks, or without a list.

What is added stands where no ray meets it, so that the picture stays the same: behind the eye and all lights.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from minirt.element import Element, fields_of
from minirt.fields import Colour, Direction, Length, Lengths, MeshField, Picture, Point, Triple
from minirt.materials import Attributes, Clouds, Compound, Glass
from minirt.rendering.image import Image
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.features import ATTRIBUTES, NEEDS, PLAIN, WORDS, features, material_features
from minirt.rendering.scene_packing import Packing
from minirt.report.settings import Change, without_boxes, without_light_buffers, without_tiles
from minirt.scene import Background, Camera, FurtherLight, Scene, SpotLight
from minirt.shapes import ALL_KINDS, Shape

SIZE = 1e-3  # of an added shape, as a share of the distance to it
GREY = (128, 128, 128)
DARK = (0, 0, 1)  # of an added background, which may be seen: the least that is not black
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


class Variant(NamedTuple):
    """A scene with something added, or the same scene packed without a list."""

    sort: str
    name: str
    change: str
    scene: Scene
    packing: tuple[Change, ...] = ()


def without_lists(scene: Scene) -> Iterator[Variant]:
    """Yield the scene packed without each list that it has. Such variants need no kernel of their own."""
    yield Variant("list", "tiles and their cones", "without", scene, (without_tiles,))
    if scene.lights:
        yield Variant("list", "light buffers and their cones", "without", scene, (without_light_buffers,))
    if features(scene) & {"reflective", "parallel"}:
        yield Variant("list", "boxes of the BVH", "without", scene, (without_boxes,))


def with_more(scene: Scene, folder: Path) -> Iterator[Variant]:
    """Yield the scene with each feature, then with each kind of shape, that it lacks; files are put into a folder."""
    used, invisible = features(scene), InvisibleElements(scene, folder)
    plain = invisible.record(next(iter({type(shape) for shape in scene.shapes}), ALL_KINDS[0].element))
    for feature, added in invisible.features(plain).items():
        if feature not in used:
            yield Variant("feature", WORDS[feature], "added", with_element(scene, added))
    for kind in ALL_KINDS:
        if kind.element not in set(map(type, scene.shapes)):
            shape = invisible.record(kind.element)
            yield Variant("kind", kind.element.plural, "added", with_element(scene, shape))


def with_element(scene: Scene, added: Any) -> Scene:
    """Return a scene with an element more; a background and a camera replace those of the scene."""
    kept = (
        each for each in scene.elements if not isinstance(added, Background | Camera) or type(each) is not type(added)
    )
    return Scene((*kept, added), scene.file)


class InvisibleElements:
    """Makes small elements at a place that no ray of a scene meets."""

    def __init__(self, scene: Scene, folder: Path) -> None:
        eye, _, _, forward = camera_numbers(scene.camera, 16, 9).reshape(4, 3)
        forward = forward / np.linalg.norm(forward)
        lights = [np.subtract(light.position, eye) for light in scene.lights if hasattr(light, "position")]
        behind = max([1.0, *(-2 * float(offset @ forward) for offset in lights)])
        self.place, self.size = eye - behind * forward, SIZE * behind
        self.back = vector(-forward)
        self.folder = folder
        self.camera = scene.camera

    def features(self, plain: Shape) -> dict[str, Any]:
        """Return an element with each feature, by the feature's key; materials are those of a `plain` shape."""
        found: dict[str, Any] = {}
        for field in fields_of(Attributes):
            value = self.value(field)
            found.setdefault(field.feature_of(value), plain.replace(**{field.name: value}))
        glass = self.record(Glass)
        found |= {feature: found[feature].replace(glass=glass) for feature in NEEDS}
        found["raised_patterns"] = plain.replace(clouds=Clouds(self.size, height=0.1))
        found["spots"] = SpotLight(position=vector(self.place), direction=self.back, angle=10.0, brightness=0.5)
        found["soft"] = FurtherLight(vector(self.place), 1e-12, size=self.size)  # so faint that no level changes
        found["lens"] = self.camera.replace(lens=self.size, focus=1.0)
        found["background"] = Background(DARK)
        found["environment"] = Background(self.picture())
        return {feature: found[feature] for feature in WORDS}

    def record(self, kind: type[Any]) -> Any:
        """Make a record of its required fields."""
        corners = iter(np.vstack([np.zeros(3), np.eye(3)]) * self.size)
        required = (field for field in fields_of(kind) if field.required)
        return kind(
            **{
                field.name: vector(self.place + next(corners)) if isinstance(field, Point) else self.value(field)
                for field in required
            }
        )

    def value(self, field: Any) -> Any:
        """Return a value of a field that is no point."""
        if isinstance(field, Compound):
            return field.check(field.parse(field.bare)) if field.bare else self.record(field.record)
        if isinstance(field, (Picture, MeshField)):
            return self.picture() if isinstance(field, Picture) else self.mesh(field)
        if isinstance(field, (Length, Lengths)) and field.unit:
            return (self.size,) * 3 if isinstance(field, Lengths) else self.size * (field.initial or 1.0)
        if isinstance(field, (Direction, Colour)):
            return self.back if isinstance(field, Direction) else GREY
        return (field.low + field.high) / 2 if field.initial is None else field.initial

    def mesh(self, field: MeshField) -> Any:
        """Write a tetrahedron into the folder, and return it as the value of a field."""
        path = self.folder / "tetrahedron.obj"
        path.write_text(TETRAHEDRON)
        return field.check(field.parse(str(path)))

    def picture(self) -> str:
        """Write a small picture into the folder, and return its path."""
        path = self.folder / "grey.png"
        Image(np.full((2, 2, 3), 128, np.uint8)).save(path)
        return str(path)


def vector(numbers: Iterable[float]) -> Triple:
    """Return three floats as a tuple."""
    x, y, z = map(float, numbers)
    return x, y, z


# Features and kinds of shapes that a scene has, and that no pixel of its picture can show.


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
    for feature, words in WORDS.items():
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
