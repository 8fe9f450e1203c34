"""Packing of materials into the arrays of the kernel; an array that no shape needs is None."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Set
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.shading.environment import Environment
from minirt.kernel.shading.texturing import SurfaceMaps
from minirt.materials import picture_cache
from minirt.rendering.packing.features import ATTRIBUTES, PLAIN
from minirt.scene import Scene
from minirt.shapes import Shape

Dressed = list[tuple[int, Shape]]  # the shapes that have materials, with their indices
MAPS = {"checks", "textures", "bumps", "normals"}  # features that `surface_maps_of` packs
Reader = Callable[[Path], np.ndarray]


class Materials(NamedTuple):
    """The fields of `minirt.kernel.scene_arrays.SceneArrays` that hold materials."""

    specular: Any
    reflective: Any
    surface_maps: Any


def materials_of(scene: Scene, owner: np.ndarray, used: Set[Hashable]) -> Materials:
    """Pack the materials of a scene that uses these features of `minirt.rendering.packing.features`.

    `owner` (n,) is for each primitive of the kernel the index of its shape.
    """
    if not used & {*ROWS, *MAPS}:  # spares a loop over a million shapes
        return Materials(None, None, None)
    shapes = [(i, shape) for i, shape in enumerate(scene.shapes) if ATTRIBUTES(shape) != PLAIN]
    count = len(scene.shapes)
    rows = {name: pack(shapes, count)[owner] if name in used else None for name, pack in ROWS.items()}
    return Materials(**rows, surface_maps=surface_maps_of(scene, shapes, owner, used) if used & MAPS else None)


def specular_of(shapes: Dressed, count: int) -> np.ndarray:
    """Specular highlights as `minirt.kernel.shading.specular` reads them, one row a shape."""
    rows = np.zeros((count, 3))
    for i, shape in shapes:
        if shape.specular:
            rows[i] = shape.specular.share, shape.specular.exponent, shape.specular.blinn
    return rows


def reflective_of(shapes: Dressed, count: int) -> np.ndarray:
    """Mirrors and glass as `minirt.kernel.shading.whitted` reads them, one row a shape.

    Shares that add up to more than 1 are scaled down alike.
    """
    rows = np.tile([0.0, 0.0, 1.0], (count, 1))
    for i, shape in shapes:
        refracted, ior = (shape.glass.share, shape.glass.ior) if shape.glass else (0.0, 1.0)
        mirrored = shape.mirror or 0.0
        total = max(1.0, mirrored + refracted)
        rows[i] = mirrored / total, refracted / total, ior
    return rows


ROWS = {
    "specular": specular_of,
    "reflective": reflective_of,
}  # by feature: fields of `Materials`


def surface_maps_of(scene: Scene, shapes: Dressed, owner: np.ndarray, used: Set[Hashable]) -> SurfaceMaps:
    """Checkerboards, textures, bump and normal maps as `minirt.kernel.shading.texturing` reads them."""
    count, album = len(scene.shapes), Album(scene)
    checks = np.zeros((count, 4))
    textures, normals, mark = np.zeros(count, np.int64), np.zeros(count, np.int64), np.zeros(count, np.int64)
    bumps = np.zeros((count, 2))
    for i, shape in shapes:
        if shape.checker:
            checks[i] = shape.checker.size, *np.divide(shape.checker.colour, 255)
        if shape.texture:
            textures[i] = album.number(shape.texture, picture_cache.picture)
        if shape.bump and shape.bump.strength:
            bumps[i] = album.number(shape.bump.file, picture_cache.heights), shape.bump.strength
        if shape.normal_map:
            normals[i] = album.number(shape.normal_map, picture_cache.picture)
        mark[i] = bool(shape.checker or shape.texture or bumps[i, 0] or shape.normal_map)
    return SurfaceMaps(
        checks=checks[owner] if "checks" in used else None,
        textures=textures[owner] if "textures" in used else None,
        bumps=bumps[owner] if "bumps" in used else None,
        normals=normals[owner] if "normals" in used else None,
        used=mark[owner],
        **album.packed(),
    )


def environment_of(scene: Scene, file: str) -> Environment:
    """Pack the picture of a background."""
    album = Album(scene)
    album.number(file, picture_cache.picture)
    return Environment(**album.packed())


class Album:
    """Collects the pictures that a scene names, each once."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.numbers: dict[tuple[Reader, str], int] = {}
        self.pictures: list[np.ndarray] = []

    def number(self, file: str, read: Reader) -> int:
        """The number of a picture, from 1 on. FileError if it cannot be read."""
        if (read, file) not in self.numbers:
            self.pictures.append(read(self.scene.beside(file)))
            self.numbers[read, file] = len(self.pictures)
        return self.numbers[read, file]

    def packed(self) -> dict[str, np.ndarray]:
        """Pack all pictures: the fields `texels` and `pictures` of `SurfaceMaps`."""
        ends = np.cumsum([image.size for image in self.pictures])
        texels = [image.ravel() * np.float32(1 / 255 if image.dtype == np.uint8 else 1) for image in self.pictures]
        rows = [
            (
                end - image.size,
                image.shape[1],
                image.shape[0],
                image.size // (image.shape[0] * image.shape[1]),
            )
            for end, image in zip(ends, self.pictures, strict=True)
        ]
        return {
            "texels": np.concatenate(texels) if texels else np.zeros(0, np.float32),
            "pictures": np.array(rows, np.int64).reshape(-1, 4),
        }
