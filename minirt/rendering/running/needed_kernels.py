"""Finds out which kernels a scene needs, without rendering it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from minirt.kernel import interpreted
from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.library import Call
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.packing.features import DEPTH
from minirt.rendering.packing.generic_kernels import FULL_DOUBLE, GenericKernel, empty_arrays
from minirt.rendering.running.kernel_features import minimal_scene
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene, parse

# With so many shapes parallel light needs a BVH.
EXAMPLE = "A 1 255,255,255\nC 0,0,-9 0,0,1 60\ndl 0,-1,0 1 255,255,255\n" + "sp 0,0,0 1 255,255,255\n" * 9
PIXEL = np.zeros((1, 1, 4), np.uint8)


def calls_for(scene: Scene, precision: str, depth: int) -> list[Call]:
    """Return calls of the kernels for a scene: of those that pack it, and of the specialised one that draws it."""
    recorder = CallRecorder()
    with np.errstate(all="ignore"):  # as the compiled functions do, which are interpreted here
        arrays = Packing(recorder, precision, depth).pack(minimal_scene(scene), 1, 1)
    return [*recorder.calls.values(), functions.frame.call(*frame_arguments(arrays, PIXEL))]


def generic_call(generic: GenericKernel) -> Call:
    """Return a call of a generic kernel."""
    return functions.frame.call(*frame_arguments(empty_arrays(generic), PIXEL))


def packing_calls() -> list[Call]:
    """Return calls of all functions that pack scenes in double precision, whose types are the same for all scenes."""
    *packing, _ = calls_for(parse(EXAMPLE).scene, "double", DEPTH)
    return packing


def ray_query() -> Call:
    """Return a call of the query for single rays, for all kinds of shapes."""
    vectors, numbers, integers = np.zeros((0, 3)), np.zeros(0), np.zeros(0, np.int64)
    tree = empty_arrays(FULL_DOUBLE).bvh
    return functions.trace_rays.call(integers, tree, vectors, vectors, numbers, integers, vectors, vectors)


class CallRecorder:
    """The functions that pack a scene, interpreted; their calls are recorded."""

    def __init__(self) -> None:
        self.calls: dict[str, Call] = {}

    def __getattr__(self, name: str) -> Callable[..., Any]:
        compiled, function = getattr(functions, name), getattr(interpreted, name)

        def run(*arguments: Any) -> Any:
            self.calls[name] = compiled.call(*arguments)
            return function(*arguments)

        return run
