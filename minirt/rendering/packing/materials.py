"""Packs materials, textures and environment maps into the arrays of the kernel; None where no shape needs one."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Set
from math import log2, sqrt
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from minirt.fields import cos_and_sin
from minirt.kernel.scene_arrays import kind_of_packed
from minirt.kernel.shading.texturing import Environment, SurfaceMaps
from minirt.lanes import Vec, dot
from minirt.materials import Glass, Mirror, Placement, pictures
from minirt.materials.pictures import check_textures
from minirt.rendering.packing.features import ATTRIBUTES, PLAIN
from minirt.rendering.packing.lights import Colours, colours_of
from minirt.rendering.packing.textures import PATTERN_FEATURES, pack_patterns
from minirt.scene import Scene
from minirt.shapes import Shape
from minirt.shapes.frames import basis
from minirt.shapes.shape import UPRIGHT

NumberedShapes = list[tuple[int, Shape]]  # shapes that have materials, with their indices
BLACK = 1e30  # absorption, in halvings for each scene unit, of what lets nothing of a colour through
HIGHEST_ROOT = 1.0 - 1e-9  # of the reflectance of a varnish; that of a perfect mirror would have an infinite index


def mirror_of(shape: Shape) -> Mirror:
    """Return the mirror of a shape; one of share 0 where it has none."""
    return shape.mirror if isinstance(shape.mirror, Mirror) else Mirror(0.0)


def shares(shape: Shape) -> tuple[float, float]:
    """Return the shares of reflected and refracted light of a shape, scaled down to 1 where their sum exceeds it."""
    reflected, refracted = mirror_of(shape).share, shape.glass.share if shape.glass else 0.0
    total = max(1.0, reflected + refracted)
    return reflected / total, refracted / total


def pack_reflective(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Share of reflection, share of refraction and refractive index of each of `count` shapes: see
    `minirt.kernel.shading.whitted`."""
    rows = np.tile([0.0, 0.0, 1.0], (count, 1))
    for i, shape in with_materials:
        rows[i] = *shares(shape), refractive_index(shape)
    return rows


def refractive_index(shape: Shape) -> float:
    """Return the refractive index of a shape; that of a varnish where it is a mirror with Fresnel reflection."""
    if shape.glass and shape.glass.share:
        return shape.glass.ior
    if not shape.fresnel:
        return 1.0
    root = min(sqrt(mirror_of(shape).share), HIGHEST_ROOT)
    return (1.0 + root) / (1.0 - root)


def pack_transparent(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Shares of reflection and refraction of each of `count` shapes, its refractive index, and how far Fresnel's
    equations count: see `minirt.kernel.shading.shadows`."""
    rows = np.tile([0.0, 0.0, 1.0, 0.0], (count, 1))
    for i, shape in with_materials:
        if shape.glass:
            rows[i] = *shares(shape), refractive_index(shape), shape.fresnel or 0.0
    return rows


def pack_media(with_materials: NumberedShapes, count: int, colours: Colours) -> np.ndarray:
    """Absorption of red, green and blue inside each of `count` shapes, and the shares of them that its surface lets
    through: see `minirt.kernel.shading.surfaces`."""
    rows = np.tile([0.0, 0.0, 0.0, 1.0, 1.0, 1.0], (count, 1))
    for i, shape in with_materials:
        if shape.tint and shape.glass and shape.glass.share:
            if shape.solid:
                rows[i, :3] = absorption(shape, colours)
            else:
                rows[i, 3:] = colours.shares(shape.tint.colour)
    return rows


def absorption(shape: Shape, colours: Colours) -> np.ndarray:
    """Return the absorption of red, green and blue by the tint of a shape, in halvings for each scene unit."""
    assert shape.tint
    shares = colours.shares(shape.tint.colour)
    return np.array([-log2(share) / shape.tint.distance if share else BLACK for share in shares])


def pack_fresnel(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Share of Fresnel reflection of each of `count` shapes."""
    rows = np.zeros(count)
    for i, shape in with_materials:
        rows[i] = shape.fresnel or 0.0
    return rows


def pack_fades(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """One over the distances at which reflected and refracted rays of each of `count` shapes are gone; 0 for never."""
    rows = np.zeros((count, 2))
    for i, shape in with_materials:
        glass = shape.glass or Glass(1.0)
        rows[i] = [1.0 / fade if fade else 0.0 for fade in (mirror_of(shape).fade, glass.fade)]
    return rows


MAP_FEATURES = {"checks", "textures", "bumps", "normals", "placements"}  # features that `pack_surface_maps` packs
Reader = Callable[[Path], np.ndarray]


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
    if not used & PACKED:  # without a look at each of a million shapes
        return Materials()
    with_materials = [(i, shape) for i, shape in enumerate(scene.shapes) if ATTRIBUTES(shape) != PLAIN]
    count, colours = len(scene.shapes), colours_of(scene.camera)
    rows = {name: pack(with_materials, count)[owner] for name, pack in ROW_PACKERS.items() if name in used}
    for name, pack_colours in COLOUR_PACKERS.items():
        if name in used:
            rows[name] = pack_colours(with_materials, count, colours)[owner]
    maps = pack_surface_maps(scene, with_materials, owner, used) if used & MAP_FEATURES else None
    patterns = pack_patterns(with_materials, owner, used, colours) if used & PATTERN_FEATURES else None
    return Materials(**rows, surface_maps=maps, patterns=patterns)


def pack_specular(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Specular share, exponent and model of each of `count` shapes: see `minirt.kernel.shading.lights`."""
    rows = np.zeros((count, 3))
    for i, shape in with_materials:
        if shape.specular:
            rows[i] = shape.specular.share, shape.specular.exponent, shape.specular.blinn
    return rows


def pack_glow(with_materials: NumberedShapes, count: int, colours: Colours) -> np.ndarray:
    """Share of its colour that each of `count` shapes emits, exposed."""
    rows = np.zeros(count)
    for i, shape in with_materials:
        rows[i] = (shape.glow or 0.0) * colours.gain
    return rows


ROW_PACKERS = {  # by feature, a field of `Materials`
    "specular": pack_specular,
    "reflective": pack_reflective,
    "transparent": pack_transparent,
    "fresnel": pack_fresnel,
    "fades": pack_fades,
}
COLOUR_PACKERS = {"media": pack_media, "glow": pack_glow}  # those that read colours, or emit light
PACKED = {*ROW_PACKERS, *COLOUR_PACKERS, *MAP_FEATURES, *PATTERN_FEATURES}


def pack_surface_maps(
    scene: Scene, with_materials: NumberedShapes, owner: np.ndarray, used: Set[Hashable]
) -> SurfaceMaps:
    """Checkers, textures, bump maps and normal maps: see `minirt.kernel.shading.texturing`."""
    count, pool, colours = len(scene.shapes), TexturePool(scene), colours_of(scene.camera)
    checks = np.zeros((count, 4))
    textures, normals, is_mapped = np.zeros(count, np.int64), np.zeros(count, np.int64), np.zeros(count, np.int64)
    bumps, placements = np.zeros((count, 2)), np.zeros((count, 15))
    for i, shape in with_materials:
        if shape.checker:
            checks[i] = shape.checker.size, *colours.shares(shape.checker.colour)
        if shape.texture:
            textures[i] = pool.number(shape.texture, colours.texture)
        if shape.bump and shape.bump.strength:
            bumps[i] = pool.number(shape.bump.file, pictures.heights), shape.bump.strength
        if shape.normal_map:
            normals[i] = pool.number(shape.normal_map, pictures.picture)
        if shape.uv or shape.map_frame():
            placements[i] = placement_numbers(shape)
        is_mapped[i] = bool(shape.checker or shape.texture or bumps[i, 0] or shape.normal_map)
    return SurfaceMaps(
        checks=checks[owner] if "checks" in used else None,
        textures=textures[owner] if "textures" in used else None,
        bumps=bumps[owner] if "bumps" in used else None,
        normals=normals[owner] if "normals" in used else None,
        placements=placements[owner] if "placements" in used else None,
        used=is_mapped[owner],
        **pool.arrays(),
    )


def placement_numbers(shape: Shape) -> tuple[float, ...]:
    """Scale, shift and turn of u and v, and own axes of a shape: a row of `SurfaceMaps.placements`."""
    uv = shape.uv or Placement(1.0, 1.0)
    z, x, y = shape.map_frame() or basis(UPRIGHT)
    frame = (part for axis in (x, y, z) for part in (axis.x, axis.y, axis.z))
    return uv.scale_u, uv.scale_v, uv.shift_u, uv.shift_v, *cos_and_sin(uv.turn), *frame


def pack_environment(scene: Scene, file: str) -> Environment:
    """Pack the environment map of a background."""
    pool = TexturePool(scene)
    pool.number(file, colours_of(scene.camera).sky)
    return Environment(**pool.arrays())


class TexturePool:
    """The images that a scene names, each loaded once, whatever the number of names and links that its file has."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.numbers: dict[tuple[Reader, str], int] = {}
        self.numbers_of_files: dict[tuple[Reader, int, int], int] = {}  # by device and inode
        self.images: list[np.ndarray] = []

    def number(self, file: str, read: Reader) -> int:
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
            total += absorption(shape, colours)
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
