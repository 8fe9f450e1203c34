"""Extends the packed arrays of a scene to the arguments of a generic kernel.

A specialised kernel is compiled for the kinds of shapes and the features of one scene. A generic kernel is the same
function, compiled for all kinds of shapes and for a fixed set of features, so that it can be compiled ahead of time:
what a scene lacks is an array without rows, which the kernel skips. Both draw the same bits.

To draw a packed scene with a generic kernel: `generic = fitting(arrays)[0]`, then call the kernel that is compiled for
the types of `empty_arrays(generic)` with `generalised(arrays, generic)` in place of the scene. All scenes have the same
types there.
"""

from __future__ import annotations

from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.bvh import nodes
from minirt.kernel.bvh.nodes import WIDTH, Tree
from minirt.kernel.rows import row_type
from minirt.kernel.scene_arrays import Group, SceneArrays
from minirt.kernel.shading.environment import Environment
from minirt.kernel.shading.patterns import COLUMNS, Patterns
from minirt.kernel.shading.texturing import SurfaceMaps
from minirt.rendering.packing.bvh import block_type
from minirt.shapes import ALL_KINDS, Kind

ABSENT = -1  # number of the group of a kind that a scene lacks
NO_TEXELS, NO_PICTURES = np.zeros(0, np.float32), np.zeros((0, 4), np.int64)


class GenericKernel(NamedTuple):
    """A generic kernel: the features that it is compiled for, beside all kinds of shapes."""

    name: str
    precision: str  # "double" or "single"
    features: frozenset[str]  # fields of `SceneArrays` and `SurfaceMaps` that are not None


OPTIONAL = tuple(name for name, default in SceneArrays._field_defaults.items() if default is None)
MAPS = ("checks", "textures", "bumps", "normals", "placements")
PLAIN = frozenset({"smooth"})  # as meshes are among all kinds of shapes
FULL = frozenset(OPTIONAL + MAPS)
# See `fits_single`.
FULL_SINGLE = PLAIN | {
    *("spots", "soft", "lens", "specular", "glow", "surface_maps", "patterns", "background", "checks", "placements")
}

FULL_DOUBLE = GenericKernel("full", "double", FULL)
# The most specialised first.
GENERIC_KERNELS = (
    GenericKernel("plain", "double", PLAIN),
    FULL_DOUBLE,
    GenericKernel("plain", "single", PLAIN),
    GenericKernel("full", "single", FULL_SINGLE),
)


def fitting(arrays: SceneArrays) -> list[GenericKernel]:
    """Return the generic kernels that can draw a packed scene, the most specialised first."""
    precision = precision_of(arrays)
    used = {name for name in OPTIONAL if getattr(arrays, name) is not None}
    used |= {name for name in MAPS if arrays.surface_maps and getattr(arrays.surface_maps, name) is not None}
    return [generic for generic in GENERIC_KERNELS if generic.precision == precision and used <= generic.features]


def precision_of(arrays: SceneArrays) -> str:
    """Return "single" for arrays of float32, and "double" for arrays of float64."""
    return "single" if arrays.camera.dtype == np.float32 else "double"


def generalised(arrays: SceneArrays, generic: GenericKernel) -> SceneArrays:
    """Return a packed scene as the argument of a generic kernel that fits it. Its arrays are shared, not copied."""
    empty = empty_arrays(generic)
    whole: SceneArrays = filled(arrays, empty)
    if empty.surface_maps is not None:
        whole = whole._replace(surface_maps=filled(whole.surface_maps, empty.surface_maps))
    if empty.patterns is not None:
        whole = whole._replace(patterns=filled(whole.patterns, empty.patterns))
    if empty.bvh is not None:
        whole = whole._replace(bvh=generalised_tree(whole.bvh))
    return whole._replace(groups=all_groups(arrays.groups, empty.groups))


def generalised_tree(tree: Tree) -> Tree:
    """Return a BVH with a group for each kind of shape, those that a scene lacks without shapes."""
    empty = empty_arrays(FULL_DOUBLE).bvh
    return tree._replace(groups=all_groups(tree.groups, empty.groups))


def filled(arrays: Any, empty: Any) -> Any:
    """Return a NamedTuple of arrays, with the fields of `empty` in place of those that are None."""
    return arrays._replace(**{name: getattr(empty, name) for name in arrays._fields if getattr(arrays, name) is None})


def all_groups(groups: tuple[Any, ...], empty: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return the groups of a scene in the order of the registry, with an `empty` one for each kind that it lacks."""
    present = {group.rows.dtype.names: group for group in groups}
    return tuple(present.get(group.rows.dtype.names, group) for group in empty)


@cache
def empty_arrays(generic: GenericKernel) -> SceneArrays:
    """Return the argument of a generic kernel for a scene without lights and shapes: all scenes have its types."""
    number: Any = np.float32 if generic.precision == "single" else np.float64
    numbers, integers, indices = (
        partial(np.zeros, dtype=number),
        partial(np.zeros, dtype=np.int64),
        np.zeros(0, np.int32),
    )
    rows = [np.zeros(0, row_type(kind, number)) for kind in ALL_KINDS]
    maps = SurfaceMaps(
        checks=numbers((0, 4)),
        textures=integers(0),
        bumps=np.zeros((0, 2)),
        normals=integers(0),
        placements=numbers((0, 15)),
        used=integers(0),
        texels=NO_TEXELS,
        pictures=NO_PICTURES,
    )
    whole = SceneArrays(
        camera=numbers(14),
        ambient=numbers(3),
        lights=numbers((0, 6)),
        colours_and_extents=numbers((0, 4)),
        slots=integers((0, 2)),
        tile_shapes=indices,
        cones=numbers((0, 5)),
        light_buffer_cells=1,
        light_buffers=numbers((0, 11)),
        light_shapes=indices,
        light_cones=numbers((0, 0, 5)),
        groups=tuple(Group(each, integers(0), integers((0, 0)), ABSENT) for each in rows),
        spots=numbers((0, 7)),
        soft=numbers((0, 4)),
        lens=numbers(0),
        specular=numbers((0, 3)),
        reflective=numbers((0, 3)),
        transparent=numbers((0, 4)),
        media=numbers((0, 6)),
        eye_medium=numbers(3),
        fresnel=numbers(0),
        fades=numbers((0, 2)),
        glow=numbers(0),
        patterns=Patterns(integers((0, 2)), numbers((0, COLUMNS)), numbers(0)),
        smooth=integers(0),
        surface_maps=maps._replace(**without(MAPS, generic)),
        background=numbers(3),
        environment=Environment(NO_TEXELS, NO_PICTURES),
        bvh=Tree(numbers(0), numbers(0), integers((0, 2)), tuple(map(empty_blocks, ALL_KINDS, rows))),
    )
    return whole._replace(**without(OPTIONAL, generic))


def without(names: tuple[str, ...], generic: GenericKernel) -> dict[str, Any]:
    """Return None for each of the features that a generic kernel lacks."""
    return dict.fromkeys(set(names) - generic.features)


def empty_blocks(kind: Kind, rows: np.ndarray) -> nodes.Group:
    """Return a group of a BVH for a kind without shapes."""
    unbounded = np.zeros(0, np.int64) if kind.infinite else None
    return nodes.Group(rows, np.zeros(0, block_type(kind)), np.zeros((0, WIDTH, 2)), unbounded, ABSENT)
