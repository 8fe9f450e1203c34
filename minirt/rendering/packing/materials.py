"""What the surfaces of a scene are made of, as the tables of the kernel; those that no shape needs are None."""

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

Worn = list[tuple[int, Shape]]  # the shapes that have attributes, with their numbers
MAPS = {"checks", "textures", "bumps", "normals"}  # features that `surface_maps_of` packs
Reader = Callable[[Path], np.ndarray]


class Materials(NamedTuple):
    """Fields of `minirt.kernel.scene_arrays.SceneArrays`."""

    specular: Any
    reflective: Any
    surface_maps: Any


def materials_of(scene: Scene, owner: np.ndarray, used: Set[Hashable]) -> Materials:
    """Pack the materials of a scene that uses these features of `minirt.rendering.packing.features`.

    `owner` (n,) tells for each primitive of the kernel to which shape it belongs.
    """
    if not used & {*ROWS, *MAPS}:  # not even a look at each of a million shapes
        return Materials(None, None, None)
    shapes = [(i, shape) for i, shape in enumerate(scene.shapes) if ATTRIBUTES(shape) != PLAIN]
    count = len(scene.shapes)
    rows = {name: pack(shapes, count)[owner] if name in used else None for name, pack in ROWS.items()}
    return Materials(**rows, surface_maps=surface_maps_of(scene, shapes, owner, used) if used & MAPS else None)


def specular_of(worn: Worn, count: int) -> np.ndarray:
    """See `minirt.kernel.shading.specular`."""
    gloss = np.zeros((count, 3))
    for i, shape in worn:
        if shape.specular:
            gloss[i] = shape.specular.share, shape.specular.exponent, shape.specular.blinn
    return gloss


def reflective_of(worn: Worn, count: int) -> np.ndarray:
    """See `minirt.kernel.shading.whitted`. Shares that are more than all together are made smaller alike."""
    bounces = np.tile([0.0, 0.0, 1.0], (count, 1))
    for i, shape in worn:
        through, ior = (shape.glass.share, shape.glass.ior) if shape.glass else (0.0, 1.0)
        back = shape.mirror or 0.0
        whole = max(1.0, back + through)
        bounces[i] = back / whole, through / whole, ior
    return bounces


ROWS = {
    "specular": specular_of,
    "reflective": reflective_of,
}  # by feature: fields of `Materials`


def surface_maps_of(scene: Scene, worn: Worn, owner: np.ndarray, used: Set[Hashable]) -> SurfaceMaps:
    """See `minirt.kernel.shading.texturing`."""
    count, album = len(scene.shapes), Album(scene)
    checks = np.zeros((count, 4))
    textures, normals, mark = np.zeros(count, np.int64), np.zeros(count, np.int64), np.zeros(count, np.int64)
    bumps = np.zeros((count, 2))
    for i, shape in worn:
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
        **album.bound(),
    )


def environment_of(scene: Scene, file: str) -> Environment:
    """The picture of a background."""
    album = Album(scene)
    album.number(file, picture_cache.picture)
    return Environment(**album.bound())


class Album:
    """The pictures that a scene names, each once."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.numbers: dict[tuple[Reader, str], int] = {}
        self.pages: list[np.ndarray] = []

    def number(self, file: str, read: Reader) -> int:
        """The number of a picture, from 1 on. FileError where there is none that can be read."""
        if (read, file) not in self.numbers:
            self.pages.append(read(self.scene.beside(file)))
            self.numbers[read, file] = len(self.pages)
        return self.numbers[read, file]

    def bound(self) -> dict[str, np.ndarray]:
        """`texels` and `pictures` of `SurfaceMaps`."""
        ends = np.cumsum([page.size for page in self.pages])
        texels = [page.ravel() * np.float32(1 / 255 if page.dtype == np.uint8 else 1) for page in self.pages]
        rows = [
            (end - page.size, page.shape[1], page.shape[0], page.size // (page.shape[0] * page.shape[1]))
            for end, page in zip(ends, self.pages, strict=True)
        ]
        return {
            "texels": np.concatenate(texels) if texels else np.zeros(0, np.float32),
            "pictures": np.array(rows, np.int64).reshape(-1, 4),
        }
