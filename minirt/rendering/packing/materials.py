"""Packs materials, textures and environment maps into the arrays of the kernel; None where no shape needs one.

Each material states its own rows: see `minirt.materials.Material.rows`.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Set
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from minirt.fields import cos_and_sin
from minirt.kernel.scene_arrays import kind_of_packed
from minirt.kernel.shading.texturing import Environment, SurfaceMaps
from minirt.lanes import Vec, dot
from minirt.materials import Placement, pictures
from minirt.materials.pictures import check_textures
from minirt.rendering.packing.features import ATTRIBUTES, FEATURES, MAPS, MATERIALS, PLAIN
from minirt.rendering.packing.lights import Colours, colours_of
from minirt.rendering.packing.textures import PATTERN_FEATURES, pack_patterns
from minirt.scene import Scene
from minirt.shapes import Shape
from minirt.shapes.frames import basis
from minirt.shapes.shape import UPRIGHT

PictureReader = Callable[[Path], np.ndarray]
OF_SHAPES = {name for name, feature in FEATURES.items() if feature.of_shapes}  # features with a row for each shape


class Materials(NamedTuple):
    """The fields of `minirt.kernel.scene_arrays.SceneArrays` about materials."""

    specular: Any = None
    reflective: Any = None
    transparent: Any = None
    media: Any = None
    fresnel: Any = None
    fades: Any = None
    glow: Any = None
    surface_maps: Any = None
    patterns: Any = None


def pack_materials(scene: Scene, owner: np.ndarray, used: Set[Hashable]) -> Materials:
    """Pack the materials of n primitives for the features that a scene uses; `owner` (n,) has the shape of each."""
    if not used & (OF_SHAPES | PATTERN_FEATURES):  # without a look at each of a million shapes
        return Materials()
    with_materials = [(i, shape) for i, shape in enumerate(scene.shapes) if ATTRIBUTES(shape) != PLAIN]
    reader = Reader(scene)
    arrays = {name: FEATURES[name].rows(len(scene.shapes)) for name in FEATURES if name in used & OF_SHAPES}
    for i, shape in with_materials:
        for name, row in rows_of(shape, reader):
            if name in arrays:
                arrays[name][i] = row
    packed = {name: array[owner] for name, array in arrays.items()}
    maps = {name: packed.pop(name) for name in MAPS if name in packed}
    surface_maps = pack_surface_maps(maps, reader, len(owner)) if maps else None
    patterns = pack_patterns(with_materials, owner, used, reader.colours) if used & PATTERN_FEATURES else None
    return Materials(**packed, surface_maps=surface_maps, patterns=patterns)


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
    """Pack the environment map of a background."""
    reader = Reader(scene)
    reader.number(file, reader.colours.sky)
    return Environment(**reader.arrays())


class Reader:
    """Reads the colours and the pictures of a scene, each picture once, whatever the number of names and links."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.colours = colours_of(scene.camera)
        self.shares, self.gain = self.colours.shares, self.colours.gain
        self.numbers: dict[tuple[PictureReader, str], int] = {}
        self.numbers_of_files: dict[tuple[PictureReader, int, int], int] = {}  # by device and inode
        self.images: list[np.ndarray] = []

    def texture(self, file: str) -> int:
        """Load colours as shares of light, and return the number of the picture."""
        return self.number(file, self.colours.texture)

    def heights(self, file: str) -> int:
        """Load a height map and return its number."""
        return self.number(file, pictures.heights)

    def normals(self, file: str) -> int:
        """Load a normal map and return its number."""
        return self.number(file, pictures.picture)

    def number(self, file: str, read: PictureReader) -> int:
        """Load an image and return its number, from 1 on. FileError where it cannot be read."""
        if (read, file) not in self.numbers:
            path = self.scene.beside(file)
            key = read, *pictures.identity(path)
            if key not in self.numbers_of_files:
                self.images.append(read(path))
                check_textures(self.images)
                self.numbers_of_files[key] = len(self.images)
            self.numbers[read, file] = self.numbers_of_files[key]
        return self.numbers[read, file]

    def arrays(self) -> dict[str, np.ndarray]:
        """Join the images into the arrays `texels` and `pictures` of `SurfaceMaps`."""
        ends = np.cumsum([image.size for image in self.images])
        texels = np.empty(int(ends[-1]) if len(ends) else 0, np.float32)
        for end, image in zip(ends, self.images, strict=True):
            share = np.float32(1 / 255 if image.dtype == np.uint8 else 1)
            np.multiply(image.ravel(), share, out=texels[end - image.size : end], dtype=np.float32)
        rows = [
            (end - image.size, image.shape[1], image.shape[0], image.size // (image.shape[0] * image.shape[1]))
            for end, image in zip(ends, self.images, strict=True)
        ]
        return {
            "texels": texels,
            "pictures": np.array(rows, np.int64).reshape(-1, 4),
        }


TOWARDS = Vec(*np.array([0.5773, 0.2113, 0.7887]) / np.linalg.norm([0.5773, 0.2113, 0.7887]))  # any direction will do


def medium_at(point: np.ndarray, shapes: tuple[Shape, ...], colours: Colours) -> np.ndarray:
    """Return the absorption of red, green and blue at a point, in halvings for each scene unit."""
    total = np.zeros(3)
    for shape in shapes:
        if ATTRIBUTES(shape) != PLAIN and shape.tint and shape.glass and shape.glass.share and encloses(shape, point):
            total += shape.tint.absorption(colours)
    return total


def encloses(shape: Shape, point: np.ndarray) -> bool:
    """Whether a point is inside of a shape: the first surface that a ray from there hits faces away from it."""
    if not shape.solid:
        return False
    plane = shape.flat()
    if plane:
        return bool(np.dot(np.subtract(point, plane[0]), plane[1]) < 0.0)
    low, high = shape.bounds() or ((-np.inf,) * 3, (np.inf,) * 3)
    if not (np.greater(point, low) & np.less(point, high)).all():
        return False
    packed, origin = shape.pack(), Vec(*point)
    kind = kind_of_packed(type(packed))
    with np.errstate(all="ignore"):
        hit, t = kind.intersect(packed, origin, TOWARDS)
        nearest = np.where(hit, t, np.inf).min()
        _, normal = kind.surface(packed, origin + nearest * TOWARDS)
        leaving = np.atleast_1d(dot(normal, TOWARDS))[np.argmin(np.atleast_1d(np.where(hit, t, np.inf)))]
    return bool(nearest < np.inf and leaving > 0.0)


# Highlights and mirrors that no pixel can show are left out of the arrays of a picture: the kernel skips a feature
# whose array has no rows, and draws the same bits. A highlight behind the eye cost 9 % of the frames of scenes/demo.rt,
# a mirror 8 %; left out like this they cost 1 % and 5 %. A kernel without the feature would save the rest, after some
# seconds of compiling, which pay off after more than a minute of rendering.


class Effective(NamedTuple):
    """Masks of the shapes that a material changes, (n,) each; None where the scene lacks the feature."""

    specular: np.ndarray | None
    reflective: np.ndarray | None


def effective(materials: Materials) -> Effective:
    """Return which shapes have a highlight, and which reflect or refract."""
    specular, reflective = materials.specular, materials.reflective
    return Effective(
        None if specular is None else specular[:, 0] > 0.0,
        None if reflective is None else reflective[:, :2].any(axis=1),
    )


def without_unseen(materials: Materials, changed: Effective, seen: np.ndarray) -> Materials:
    """Return materials without the rows of the features that no pixel can show.

    `seen` has the shapes of the lists of all tiles, which may repeat. Mirrors and glass that are seen may show every
    shape.
    """
    if changed.reflective is not None:
        if changed.reflective[seen].any():
            return materials
        materials = materials._replace(reflective=materials.reflective[:0])  # light still shines through glass
    if changed.specular is not None and not changed.specular[seen].any():
        materials = materials._replace(specular=materials.specular[:0])
    return materials
