"""Scene -> the arrays that the kernel reads; an edit packs again only the shapes that it changed."""

from __future__ import annotations

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.kernel.rows import row, row_type
from minirt.kernel.traced import Group, Traced
from minirt.rendering.camera import camera_numbers
from minirt.rendering.sight import Lists, grid_for, seen_by_eye, seen_by_lamp
from minirt.scene import Ambient, Light, Scene
from minirt.shapes import KINDS, Ball, Shape

ENDLESS: tuple[Ball, ...] = (((0.0, 0.0, 0.0), np.inf),)


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
    lamps: dict[bytes, Lists]  # of the last scene, by the place of each lamp

    def __init__(self) -> None:
        self.lay_out(())

    def pack(self, scene: Scene, width: int, height: int) -> Traced:
        """The scene, seen in a picture of that size."""
        self.pack_shapes(scene.shapes)
        camera = camera_numbers(scene.camera, width, height)
        lights = light_numbers(scene)
        kinds = self.places[:, 0]
        starts, seen, near = seen_by_eye(self.balls, kinds, camera, width, height)
        grid = grid_for(len(scene.shapes))
        self.lamps = {lamp[:3].tobytes(): self.lists_of(lamp[:3], grid) for lamp in lights}
        lamps = [self.lamps[lamp[:3].tobytes()] for lamp in lights]
        before = np.cumsum([0, *(len(lit) for _, lit, _ in lamps)])
        lamp_starts = [starts + before[i] for i, (starts, _, _) in enumerate(lamps)]
        lamp_table = stacked(lamp_starts, (len(self.rows), 6 * grid * grid + 1), np.int64)
        return Traced(
            camera=camera,
            ambient=light_of(scene.ambient) if scene.ambient else np.zeros(3),
            lights=lights,
            colours=self.colours,
            extents=self.extents,
            places=self.places,
            seen=seen,
            near=near,
            grid=grid,
            lit=np.concatenate([np.zeros(0, np.int64), *(lit for _, lit, _ in lamps)]),
            lamp_near=stacked([near for _, _, near in lamps], near.shape, np.float64),
            groups=tuple(
                Group(rows, starts[kind], np.ascontiguousarray(lamp_table[:, kind]))
                for kind, rows in enumerate(self.rows)
            ),
        )

    def lists_of(self, lamp: np.ndarray, grid: int) -> Lists:
        """Which shapes a lamp sees where, worked out once for as long as neither it nor a shape moves."""
        known = self.lamps.get(lamp.tobytes())
        return known or seen_by_lamp(self.balls, self.places[:, 0], lamp, grid)

    def pack_shapes(self, shapes: tuple[Shape, ...]) -> None:
        """Bring the arrays of shapes up to date."""
        if [type(new) for new in shapes] != [type(old) for old in self.shapes]:
            self.lay_out(shapes)
        for index, (new, old) in enumerate(zip(shapes, self.shapes, strict=True)):
            if new is not old:
                self.lamps.clear()
                group, place = self.places[index]
                self.rows[group][place] = row(new.pack())
                self.colours[index] = np.divide(new.colour, 255)
                self.extents[index] = extent(new)
                balls = new.balls() or ENDLESS
                self.balls[index] = [
                    (*centre, radius) for centre, radius in balls + balls[-1:] * (self.balls.shape[1] - len(balls))
                ]
        self.shapes = shapes

    def lay_out(self, shapes: tuple[Shape, ...]) -> None:
        """Make room for as many shapes of the same kinds, those of one kind in one array."""
        kinds = [type(shape) for shape in shapes]
        used = [kind for kind in KINDS if kind.element in kinds]
        self.rows = tuple(np.zeros(kinds.count(kind.element), row_type(kind)) for kind in used)
        self.places = np.zeros((len(kinds), 2), np.int64)
        for group, kind in enumerate(used):
            members = [index for index, each in enumerate(kinds) if each is kind.element]
            self.places[members, 0] = group
            self.places[members, 1] = range(len(members))
        self.balls = np.zeros((len(kinds), max((len(shape.balls()) for shape in shapes), default=0) or 1, 4))
        self.colours = np.zeros((len(kinds), 3))
        self.extents = np.zeros(len(kinds))
        self.lamps = {}
        self.shapes = (None,) * len(kinds)


def stacked(parts: list[np.ndarray], shape: tuple[int, ...], dtype: type) -> np.ndarray:
    """The arrays one above the other, also where there are none."""
    return np.stack(parts) if parts else np.zeros((0, *shape), dtype)
