"""Scene -> the arrays that the kernel reads; an edit packs again only the shapes that it changed."""

from __future__ import annotations

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.kernel.rows import row, row_type
from minirt.kernel.traced import Traced
from minirt.rendering.camera import camera_numbers
from minirt.scene import Ambient, Light, Scene
from minirt.shapes import KINDS, Shape


def light_of(source: Ambient | Light) -> np.ndarray:
    """The light of a source at full incidence: red, green, blue."""
    return np.divide(source.colour, 255) * source.brightness


def light_numbers(scene: Scene) -> np.ndarray:
    """Place and light of every lamp that shines."""
    lamps = [np.concatenate([lamp.position, light_of(lamp)]) for lamp in scene.lights if light_of(lamp).any()]
    return np.array(lamps).reshape(len(lamps), 6)


def extent(shape: Shape) -> float:
    """The largest coordinate of a shape; of one without end, the largest of its points."""
    points = shape.bounds() or [getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point)]
    return max(abs(float(coordinate)) for point in points for coordinate in point)


class Packing:
    """Packs scene after scene, and keeps what did not change since the last."""

    shapes: tuple[Shape | None, ...]

    def __init__(self) -> None:
        self.lay_out(())

    def pack(self, scene: Scene, width: int, height: int) -> Traced:
        """The scene, seen in a picture of that size."""
        self.pack_shapes(scene.shapes)
        ambient = light_of(scene.ambient) if scene.ambient else np.zeros(3)
        camera = camera_numbers(scene.camera, width, height)
        return Traced(camera, ambient, light_numbers(scene), self.colours, self.extents, self.places, self.groups)

    def pack_shapes(self, shapes: tuple[Shape, ...]) -> None:
        """Bring the arrays of shapes up to date."""
        if [type(new) for new in shapes] != [type(old) for old in self.shapes]:
            self.lay_out(shapes)
        for index, (new, old) in enumerate(zip(shapes, self.shapes, strict=True)):
            if new is not old:
                group, place = self.places[index]
                self.groups[group][place] = row(index, new.pack())
                self.colours[index] = np.divide(new.colour, 255)
                self.extents[index] = extent(new)
        self.shapes = shapes

    def lay_out(self, shapes: tuple[Shape, ...]) -> None:
        """Make room for as many shapes of the same kinds, those of one kind in one array."""
        kinds = [type(shape) for shape in shapes]
        used = [kind for kind in KINDS if kind.element in kinds]
        self.groups = tuple(np.zeros(kinds.count(kind.element), row_type(kind)) for kind in used)
        self.places = np.zeros((len(kinds), 2), np.int64)
        for group, kind in enumerate(used):
            members = [index for index, each in enumerate(kinds) if each is kind.element]
            self.places[members, 0] = group
            self.places[members, 1] = range(len(members))
        self.colours = np.zeros((len(kinds), 3))
        self.extents = np.zeros(len(kinds))
        self.shapes = (None,) * len(kinds)
