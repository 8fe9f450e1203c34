"""Compiled kernels of frames: one for each combination of shape kinds, features and precision of a scene.

What a scene does not use is not in its kernel: formulas are chosen by the types of shapes, and fields of the scene that
are None take their code with them.
"""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from typing import Any, TypeAlias

import numpy as np
from numba import typeof

from minirt.kernel import frame
from minirt.kernel.compiler import compilation, kernel_functions  # noqa: F401  (registers what a frame calls)
from minirt.kernel.compiler.compilation import CACHE, compiled
from minirt.kernel.scene_arrays import SceneArrays

Arguments: TypeAlias = tuple[Any, ...]  # of `minirt.kernel.frame.frame`

KERNELS_IN_MEMORY = 8  # where a kernel that was dropped can be loaded from disk
OPTIONAL_FIELDS = tuple(name for name, default in SceneArrays._field_defaults.items() if default is None)
SURFACE_MAPS = ("checks", "textures", "bumps", "normals")


@lru_cache(KERNELS_IN_MEMORY if CACHE else None)
def kernel_of(features: tuple[str, ...], *row_types: np.dtype[Any]) -> Any:
    """Return the kernel for shapes in rows of these types and for `features` of a scene. It is compiled or loaded when
    it is first called.
    """
    if "bvh" in features:
        import_module("minirt.kernel.compiler.jit_bvh")
    return compiled(frame.frame, CACHE)


def kernel_for(scene: SceneArrays) -> Any:
    """Return the kernel for a scene."""
    maps = fields_present(scene.surface_maps, SURFACE_MAPS) if scene.surface_maps else []
    features = [*fields_present(scene, OPTIONAL_FIELDS), *maps]
    return kernel_of(tuple(features), *(group.rows.dtype for group in scene.groups))


def fields_present(table: Any, names: tuple[str, ...]) -> list[str]:
    """Return the names of the fields that are not None."""
    return [name for name in names if getattr(table, name) is not None]


def compile(arguments: Arguments) -> None:
    """Compile the kernel for arguments of these types, or load it where an earlier run has compiled it."""
    kernel_for(arguments[-1]).compile(tuple(map(typeof, arguments)))


def is_compiled(arguments: Arguments) -> bool:
    """Whether the kernel for arguments of these types needs no compiling: it is in memory or on disk."""
    return compilation.is_compiled(kernel_for(arguments[-1]), tuple(map(typeof, arguments)))
