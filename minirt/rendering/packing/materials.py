"""Packs materials, textures, patterns and environment maps into the arrays of the kernel.

Each material states its own rows: see `minirt.materials.Material.rows`.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Set
from typing import Any

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point, cos_and_sin
from minirt.helpers import file_io
from minirt.kernel.scene_arrays import kind_of_packed
from minirt.kernel.shading.patterns import CLOUDS, COLUMNS, MARBLE, WOOD, Patterns
from minirt.kernel.shading.texturing import Environment, SurfaceMaps
from minirt.lanes import Vec, cross, dot, unit
from minirt.materials import Placement, pictures
from minirt.materials.pictures import check_textures
from minirt.rendering.packing.features import ATTRIBUTES, FEATURES, MAPS, MATERIALS, NO_MATERIALS
from minirt.rendering.packing.lights import Colours, colours_of
from minirt.rendering.packing.looks import by_primitive, looks_of
from minirt.rendering.packing.ray_casting import cast
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Camera, Scene
from minirt.shapes import Shape
from minirt.shapes.frames import basis
from minirt.shapes.shape import UPRIGHT, Flat, Oriented, union_of_bounds
from minirt.shapes.triangle import Triangle

PictureReader = Callable[..., np.ndarray]  # of a path
PATTERN_FEATURES = {"patterns", "raised_patterns"}
KINDS = {"marble": MARBLE, "wood": WOOD, "clouds": CLOUDS}  # in the order in which a shape gets them
BEHIND = 3.5  # sizes from a flat surface to the middle of its rings

Frame = tuple[Vec, Vec, Vec, Vec]  # origin and three axes, the last one along the grain of wood
OF_SHAPES = {name for name, feature in FEATURES.items() if feature.of_shapes}  # features with a row for each shape


def pack_materials(scene: Scene, primitives: ShapeArrays, used: Set[Hashable]) -> dict[str, Any]:
    """Pack the materials of n primitives for the `used` features of a scene.

    Return fields of `minirt.kernel.scene_arrays.SceneArrays` by their names; those that are missing are None there.
    """
    if not used & (OF_SHAPES | PATTERN_FEATURES):  # without a look at each of a million shapes
        return {}
    shapes, look_of = looks_of(primitives)
    with_materials = [(i, shape) for i, shape in enumerate(shapes) if ATTRIBUTES(shape) != NO_MATERIALS]
    reader = Reader(scene)
    arrays = {name: FEATURES[name].rows(len(shapes)) for name in FEATURES if name in used & OF_SHAPES}
    for i, shape in with_materials:
        for name, row in rows_of(shape, reader):
            if name in arrays:
                arrays[name][i] = row
    packed: dict[str, Any] = {name: by_primitive(primitives, name, rows, look_of) for name, rows in arrays.items()}
    if "transparent" in packed:
        mark_mixed(packed["transparent"], primitives.owner)
    maps = {name: packed.pop(name) for name in MAPS if name in packed}
    if maps:
        packed["surface_maps"] = pack_surface_maps(maps, reader, len(look_of))
    if used & PATTERN_FEATURES:
        packed["patterns"] = pack_patterns(with_materials, len(shapes), look_of, used, reader.colours)
    return packed


def mark_mixed(transparent: np.ndarray, owner: np.ndarray) -> None:
    """Mark the primitives of shapes that have both glass and opaque ones, in `SceneArrays.transparent`."""
    glass = np.bincount(owner, transparent[:, 1] > 0)
    mixed = (glass > 0) & (glass < np.bincount(owner))
    transparent[:, 4] = mixed[owner]


def rows_of(shape: Shape, reader: Reader) -> list[tuple[str, Any]]:
    """Return the rows of a shape in the arrays of features, by their names."""
    values = zip(MATERIALS, ATTRIBUTES(shape), strict=True)
    rows = [
        row for (_, field), value in values if value is not None for row in field.rows(value, shape, reader).items()
    ]
    return [*rows, ("placements", placement_numbers(shape))] if shape.uv or shape.map_frame() else rows


def pack_surface_maps(maps: dict[str, np.ndarray], reader: Reader, count: int) -> SurfaceMaps:
    """Join the rows of maps and their pictures: see `minirt.kernel.shading.texturing`."""
    used = np.zeros(count, np.int64)
    for name, rows in maps.items():
        if name != "placements":
            used |= rows.reshape(count, -1)[:, 0] != 0
    return SurfaceMaps(**(dict.fromkeys(MAPS) | maps), used=used, **reader.arrays())


def placement_numbers(shape: Shape) -> tuple[float, ...]:
    """Scale, shift and turn of u and v, and own axes of a shape: a row of `SurfaceMaps.placements`."""
    uv = shape.uv or Placement(1.0, 1.0)
    z, x, y = shape.map_frame() or basis(UPRIGHT)
    frame = (part for axis in (x, y, z) for part in (axis.x, axis.y, axis.z))
    return uv.scale_u, uv.scale_v, uv.shift_u, uv.shift_v, *cos_and_sin(uv.turn), *frame


def pack_environment(scene: Scene, file: str) -> Environment:
    reader = Reader(scene)
    reader.number(file, reader.colours.sky)
    return Environment(**reader.arrays())


def pack_patterns(
    shapes: Iterable[tuple[int, Shape]], count: int, owner: np.ndarray, used: Set[Hashable], colours: Colours
) -> Patterns:
    """Pack the patterns of shapes, given with their indices below `count`, for kernels with the `used` features.

    `owner` (n,) has the index of the shape of each primitive; some shapes may have no primitive.
    """
    rows: list[list[float]] = []
    heights: list[float] = []
    ranges = np.zeros((count, 2), np.int64)
    for index, shape in shapes:
        first = len(rows)
        for name, kind in KINDS.items():
            pattern = getattr(shape, name)
            if pattern:
                numbers = [kind, *colours.shares(pattern.colour), pattern.octaves, 1 / pattern.size]
                rows.append([*numbers, *(part for v in pattern_frame(shape, pattern.size) for part in (v.x, v.y, v.z))])
                heights.append(pattern.height * pattern.size)
        ranges[index] = first, len(rows)
    packed = np.array(rows, np.float64).reshape(-1, COLUMNS)
    return Patterns(ranges[owner], packed, np.array(heights) if "raised_patterns" in used else None)


def pattern_frame(shape: Shape, size: float) -> Frame:
    """Return the frame in which a pattern of this size lies: it moves and turns with the shape.

    The grain of wood runs along the axis of a shape, and on flat shapes to the right.
    """
    origin = Vec(*next(getattr(shape, field.name) for field in fields_of(type(shape)) if isinstance(field, Point)))
    x, y, z = own_axes(shape)
    if isinstance(shape, Flat | Triangle):
        return origin - BEHIND * size * z, y, z, x
    return origin, x, y, z


def own_axes(shape: Shape) -> tuple[Vec, Vec, Vec]:
    """Return the right-handed axes of a shape, the last one its axis or normal: y where it has neither."""
    if isinstance(shape, Triangle):
        along, normal = Vec(*np.subtract(shape.b, shape.a)), Vec(*shape.normal())
        return unit(along), unit(cross(normal, along)), normal
    return shape.frame() if isinstance(shape, Oriented) else basis(UPRIGHT)


class Reader:
    """Reads the colours and the pictures of a scene, each picture once, whatever the number of names and links."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.colours = colours_of(scene.camera)
        self.shares, self.gain = self.colours.shares, self.colours.gain
        self.numbers: dict[tuple[Hashable, ...], int] = {}  # by how they are read, device and inode
        self.images: list[np.ndarray] = []

    def texture(self, file: str, colour: tuple[float, ...]) -> int:
        """Load colours as shares of light, multiplied by those of a colour, and return the number of the picture."""
        if self.colours.decodes or min(colour) < 255:
            return self.number(file, self.colours.texture, colour)
        return self.number(file, pictures.picture)

    def heights(self, file: str) -> int:
        return self.number(file, pictures.heights)

    def normals(self, file: str) -> int:
        return self.number(file, pictures.picture)

    def number(self, file: str, read: PictureReader, *how: Hashable) -> int:
        """Load an image and return its number, from 1 on. FileError where it cannot be read."""
        path = self.scene.beside(file)
        status = file_io.status(path, file_io.LARGEST_ASSET)
        key = read, *how, status.st_dev, status.st_ino  # which all links to it share
        if key not in self.numbers:
            self.images.append(read(path, *how))
            check_textures(self.images)
            self.numbers[key] = len(self.images)
        return self.numbers[key]

    def arrays(self) -> dict[str, np.ndarray]:
        """Join the images into the arrays `texels` and `pictures` of `SurfaceMaps`."""
        texels, start = np.empty(sum(image.size for image in self.images), np.float32), 0
        rows = []
        for image in self.images:
            share = np.float32(1 / 255 if image.dtype == np.uint8 else 1)
            np.multiply(image.ravel(), share, out=texels[start : start + image.size], dtype=np.float32)
            height, width = image.shape[:2]
            rows.append((start, width, height, image.size // (height * width)))
            start += image.size
        return {"texels": texels, "pictures": np.array(rows, np.int64).reshape(-1, 4)}


TOWARDS = Vec(*np.array([0.5773, 0.2113, 0.7887]) / np.linalg.norm([0.5773, 0.2113, 0.7887]))  # any direction will do


def tinted(primitives: ShapeArrays) -> list[Shape]:
    """Return the shapes of tinted glass."""
    shapes = (shape for shape in primitives.shapes if ATTRIBUTES(shape) != NO_MATERIALS)
    return [shape for shape in shapes if shape.tint and shape.glass and shape.glass.share]


def medium_at(camera: Camera, tinted: Iterable[Shape]) -> np.ndarray:
    """Return the absorption of red, green and blue at the eye, in halvings for each scene unit, by the shapes of tinted
    glass."""
    total, eye, colours = np.zeros(3), np.array(camera.position), colours_of(camera)
    for shape in tinted:
        if shape.tint and encloses(shape, eye):
            total += shape.tint.absorption(colours)
    return total


def encloses(shape: Shape, point: np.ndarray) -> bool:
    """Whether a point is inside of a shape: the first surface that a ray from there hits faces away from it."""
    if not shape.solid:
        return False
    at, bounds = (point[0], point[1], point[2]), shape.bounds()
    if bounds and union_of_bounds(bounds, (at, at)) != bounds:
        return False  # it is outside of the bounding box
    if plane := shape.infinite_plane():
        on_plane, normal = plane
        return bool(np.dot(np.subtract(point, on_plane), normal) < 0.0)
    packed, origin = shape.pack(), Vec(*point)
    kind = kind_of_packed(type(packed))
    distances = np.atleast_1d(cast(packed, origin, TOWARDS))
    first = np.argmin(distances)
    with np.errstate(all="ignore"):
        _, hit_normal = kind.surface(packed, origin + distances[first] * TOWARDS)
        leaving = np.atleast_1d(dot(hit_normal, TOWARDS))[first]
    return bool(distances[first] < np.inf and leaving > 0.0)
