"""Packed scenes as arguments of generic kernels.

A generic kernel is the same function as a specialised one, compiled for all kinds of shapes and for a fixed set of
features. What a scene lacks is an array without rows, which the kernel skips.
"""

from __future__ import annotations

from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.bvh_nodes import WIDE, LeafGroup, MeshTrees, Tree
from minirt.kernel.pixels import TILE
from minirt.kernel.scene_arrays import TRIANGLE_ROW, Group, MeshTriangles, SceneArrays, row_type
from minirt.kernel.shading.lights import LightGrid
from minirt.kernel.shading.patterns import COLUMNS, Patterns
from minirt.kernel.shading.texturing import Environment, SurfaceMaps
from minirt.rendering.packing.bvh import Meshes, block_type
from minirt.rendering.packing.features import FEATURES, MAPS
from minirt.shapes import ALL_KINDS, MESH, Kind

ABSENT = -1  # number of the group of a kind that a scene lacks
NO_TEXELS, NO_PICTURES = np.zeros(0, np.float32), np.zeros((0, 4), np.int64)


class GenericKernel(NamedTuple):
    """A generic kernel: the features that it is compiled for, beside all kinds of shapes."""

    name: str
    precision: str  # "double" or "single"
    features: frozenset[str]  # fields of `SceneArrays` and `SurfaceMaps` that are not None


OPTIONAL = tuple(name for name, default in SceneArrays._field_defaults.items() if default is None)
ROWS = tuple(name for name in OPTIONAL if name in FEATURES and name not in ("patterns", "environment"))
FEWEST = frozenset({"smooth"})  # as meshes are among all kinds of shapes
FULL = frozenset(OPTIONAL + MAPS)
FULL_SINGLE = FEWEST | {"surface_maps", "light_grid"} | {name for name, feature in FEATURES.items() if feature.single}

FULL_DOUBLE = GenericKernel("full", "double", FULL)
# The most specialised first.
GENERIC_KERNELS = (
    GenericKernel("plain", "double", FEWEST),
    FULL_DOUBLE,
    GenericKernel("plain", "single", FEWEST),
    GenericKernel("full", "single", FULL_SINGLE),
)


def fitting(arrays: SceneArrays) -> list[GenericKernel]:
    """Return the generic kernels that can draw a packed scene, the most specialised first."""
    precision = "single" if arrays.camera.dtype == np.float32 else "double"
    used = {name for name in OPTIONAL if getattr(arrays, name) is not None}
    used |= {name for name in MAPS if arrays.surface_maps and getattr(arrays.surface_maps, name) is not None}
    return [generic for generic in GENERIC_KERNELS if generic.precision == precision and used <= generic.features]


def generalised(arrays: Any, empty: Any) -> Any:
    """Return a packed scene, or its BVH, as the argument of a generic kernel that fits it. Its arrays are shared, not
    copied.

    `empty` is the same part of the `empty_arrays` of that kernel, whose fields replace those that are None. Groups are
    in the order of the registry, with the empty one for each kind of shape that is missing.
    """
    if arrays is None:
        return empty
    if not hasattr(empty, "_fields"):  # no record: an array, or a number
        return arrays
    parts = {name: generalised(getattr(arrays, name), getattr(empty, name)) for name in arrays._fields}
    whole = arrays._replace(**parts)
    if not hasattr(arrays, "groups"):
        return whole
    present = {group.rows.dtype.names: group for group in arrays.groups}
    return whole._replace(groups=tuple(present.get(group.rows.dtype.names, group) for group in empty.groups))


@cache
def empty_arrays(generic: GenericKernel) -> SceneArrays:
    """Return the argument of a generic kernel for a scene without lights and shapes: all scenes have its types."""
    number: Any = np.float32 if generic.precision == "single" else np.float64
    numbers, integers = partial(np.zeros, dtype=number), partial(np.zeros, dtype=np.int64)
    rows, indices = [np.zeros(0, row_type(kind, number)) for kind in ALL_KINDS], np.zeros(0, np.int32)
    corners, three, nine = indices.reshape(0, 3), numbers((0, 3)), numbers((0, 9))
    triangles = MeshTriangles(three, three, corners, indices, nine, nine, numbers((0, 6)))
    trees = MeshTrees(np.zeros(0, np.float32), integers((0, 2)), numbers((0, 14)), integers(0))
    maps = {name: FEATURES[name].rows(0, number) for name in MAPS if name in generic.features}
    absent = indices, indices.reshape(0, 0), ABSENT
    features: dict[str, Any] = {name: FEATURES[name].rows(0, number) for name in ROWS if name != "background"}
    lacking: dict[str, Any] = dict.fromkeys(set(OPTIONAL) - generic.features)
    whole = SceneArrays(
        camera=numbers(14),
        ambient=numbers(3),
        lights=numbers((0, 6)),
        colours_and_extents=numbers((0, 4)),
        slots=integers((0, 2)),
        listed=indices.reshape(0, 4),
        tile_shapes=indices,
        cones=numbers((0, 5)),
        square=TILE,
        light_buffer_cells=1,
        light_shapes=indices,
        light_cones=numbers((0, 0, 5)),
        groups=tuple(
            Group(np.zeros(0, TRIANGLE_ROW), *absent, trees, triangles) if kind is MESH else Group(each, *absent)
            for kind, each in zip(ALL_KINDS, rows, strict=True)
        ),
        light_grid=LightGrid(numbers((0, 8)), indices, indices),
        eye_medium=numbers(3),
        patterns=Patterns(integers((0, 2)), numbers((0, COLUMNS)), numbers(0)),
        smooth=integers(0),
        surface_maps=SurfaceMaps(
            **dict.fromkeys(MAPS) | maps, used=integers(0), texels=NO_TEXELS, pictures=NO_PICTURES
        ),
        environment=Environment(NO_TEXELS, NO_PICTURES),
        bvh=Tree(
            np.zeros(0, np.float32),
            numbers(14),
            numbers(0),
            integers((0, 2)),
            tuple(empty_blocks(kind, each, (trees, triangles)) for kind, each in zip(ALL_KINDS, rows, strict=True)),
        ),
        **features,
        background=numbers(3),
    )
    return whole._replace(**lacking)


def empty_blocks(kind: Kind, rows: np.ndarray, meshes: Meshes) -> LeafGroup:
    labels = np.zeros((0, WIDE, 2))
    if kind is MESH:
        blocks = np.zeros((0, WIDE), np.int64)
        return LeafGroup(np.zeros(0, TRIANGLE_ROW), blocks, labels, None, 0, ABSENT, *meshes)
    unbounded = np.zeros(0, np.int64) if kind.element.infinite else None
    return LeafGroup(rows, np.zeros(0, block_type(kind)), labels, unbounded, 0, ABSENT)
