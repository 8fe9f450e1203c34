"""Packs materials, textures and environment maps into the arrays of the kernel; None where no shape needs one."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Set
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.shading.environment import Environment
from minirt.kernel.shading.texturing import SurfaceMaps
from minirt.materials import picture_cache
from minirt.rendering.packing.features import ATTRIBUTES, PLAIN
from minirt.rendering.packing.patterns import PATTERN_FEATURES, pack_patterns
from minirt.scene import Scene
from minirt.shapes import Shape

NumberedShapes = list[tuple[int, Shape]]  # shapes that have materials, with their indices
MAP_FEATURES = {"checks", "textures", "bumps", "normals"}  # features that `pack_surface_maps` packs
Reader = Callable[[Path], np.ndarray]


class Materials(NamedTuple):
    """The fields of `minirt.kernel.scene_arrays.SceneArrays` about materials."""

    specular: Any
    reflective: Any
    surface_maps: Any
    patterns: Any


def pack_materials(scene: Scene, owner: np.ndarray, used: Set[Hashable]) -> Materials:
    """Pack the materials of n primitives for the features that a scene uses; `owner` (n,) has the shape of each."""
    if not used & {*ROW_PACKERS, *MAP_FEATURES, *PATTERN_FEATURES}:  # without a look at each of a million shapes
        return Materials(None, None, None, None)
    with_materials = [(i, shape) for i, shape in enumerate(scene.shapes) if ATTRIBUTES(shape) != PLAIN]
    count = len(scene.shapes)
    rows = {name: pack(with_materials, count)[owner] if name in used else None for name, pack in ROW_PACKERS.items()}
    maps = pack_surface_maps(scene, with_materials, owner, used) if used & MAP_FEATURES else None
    patterns = pack_patterns(with_materials, owner, used) if used & PATTERN_FEATURES else None
    return Materials(**rows, surface_maps=maps, patterns=patterns)


def pack_specular(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Specular share, exponent and model of each of `count` shapes: see `minirt.kernel.shading.specular`."""
    rows = np.zeros((count, 3))
    for i, shape in with_materials:
        if shape.specular:
            rows[i] = shape.specular.share, shape.specular.exponent, shape.specular.blinn
    return rows


def pack_reflective(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Share of reflection, share of refraction and refractive index of each of `count` shapes: see
    `minirt.kernel.shading.whitted`. Shares that exceed 1 together are scaled down to 1."""
    rows = np.tile([0.0, 0.0, 1.0], (count, 1))
    for i, shape in with_materials:
        refracted, ior = (shape.glass.share, shape.glass.ior) if shape.glass else (0.0, 1.0)
        reflected = shape.mirror or 0.0
        total = max(1.0, reflected + refracted)
        rows[i] = reflected / total, refracted / total, ior
    return rows


ROW_PACKERS = {  # by feature, a field of `Materials`
    "specular": pack_specular,
    "reflective": pack_reflective,
}


def pack_surface_maps(
    scene: Scene, with_materials: NumberedShapes, owner: np.ndarray, used: Set[Hashable]
) -> SurfaceMaps:
    """Checkers, textures, bump maps and normal maps: see `minirt.kernel.shading.texturing`."""
    count, pool = len(scene.shapes), TexturePool(scene)
    checks = np.zeros((count, 4))
    textures, normals, is_mapped = np.zeros(count, np.int64), np.zeros(count, np.int64), np.zeros(count, np.int64)
    bumps = np.zeros((count, 2))
    for i, shape in with_materials:
        if shape.checker:
            checks[i] = shape.checker.size, *np.divide(shape.checker.colour, 255)
        if shape.texture:
            textures[i] = pool.number(shape.texture, picture_cache.picture)
        if shape.bump and shape.bump.strength:
            bumps[i] = pool.number(shape.bump.file, picture_cache.heights), shape.bump.strength
        if shape.normal_map:
            normals[i] = pool.number(shape.normal_map, picture_cache.picture)
        is_mapped[i] = bool(shape.checker or shape.texture or bumps[i, 0] or shape.normal_map)
    return SurfaceMaps(
        checks=checks[owner] if "checks" in used else None,
        textures=textures[owner] if "textures" in used else None,
        bumps=bumps[owner] if "bumps" in used else None,
        normals=normals[owner] if "normals" in used else None,
        used=is_mapped[owner],
        **pool.arrays(),
    )


def pack_environment(scene: Scene, file: str) -> Environment:
    """Pack the environment map of a background."""
    pool = TexturePool(scene)
    pool.number(file, picture_cache.picture)
    return Environment(**pool.arrays())


class TexturePool:
    """The images that a scene names, each loaded once."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.numbers: dict[tuple[Reader, str], int] = {}
        self.images: list[np.ndarray] = []

    def number(self, file: str, read: Reader) -> int:
        """Load an image and return its number, from 1 on. FileError where it cannot be read."""
        if (read, file) not in self.numbers:
            self.images.append(read(self.scene.beside(file)))
            self.numbers[read, file] = len(self.images)
        return self.numbers[read, file]

    def arrays(self) -> dict[str, np.ndarray]:
        """Join the images into the arrays `texels` and `pictures` of `SurfaceMaps`."""
        ends = np.cumsum([image.size for image in self.images])
        texels = [image.ravel() * np.float32(1 / 255 if image.dtype == np.uint8 else 1) for image in self.images]
        rows = [
            (end - image.size, image.shape[1], image.shape[0], image.size // (image.shape[0] * image.shape[1]))
            for end, image in zip(ends, self.images, strict=True)
        ]
        return {
            "texels": np.concatenate(texels) if texels else np.zeros(0, np.float32),
            "pictures": np.array(rows, np.int64).reshape(-1, 4),
        }
