"""Packs materials, textures and environment maps into the arrays of the kernel; None where no shape needs one."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Set
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from minirt.fields import cos_and_sin
from minirt.kernel.shading.environment import Environment
from minirt.kernel.shading.texturing import SurfaceMaps
from minirt.materials import Placement, picture_cache
from minirt.materials.picture_cache import check_textures
from minirt.rendering.packing import secondary_rays
from minirt.rendering.packing.colours import Colours, colours_of
from minirt.rendering.packing.features import ATTRIBUTES, PLAIN
from minirt.rendering.packing.patterns import PATTERN_FEATURES, pack_patterns
from minirt.rendering.packing.secondary_rays import NumberedShapes
from minirt.scene import Scene
from minirt.shapes import Shape
from minirt.shapes.basis import basis
from minirt.shapes.oriented import UPRIGHT

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
    """Specular share, exponent and model of each of `count` shapes: see `minirt.kernel.shading.specular`."""
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
    "reflective": secondary_rays.pack_reflective,
    "transparent": secondary_rays.pack_transparent,
    "fresnel": secondary_rays.pack_fresnel,
    "fades": secondary_rays.pack_fades,
}
COLOUR_PACKERS = {"media": secondary_rays.pack_media, "glow": pack_glow}  # those that read colours, or emit light
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
            bumps[i] = pool.number(shape.bump.file, picture_cache.heights), shape.bump.strength
        if shape.normal_map:
            normals[i] = pool.number(shape.normal_map, picture_cache.picture)
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
            key = read, *picture_cache.identity(path)
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
