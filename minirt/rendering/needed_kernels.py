"""The kernels that a scene needs, found without rendering it, by a small scene that needs the same ones."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any

import numpy as np

from minirt.kernel import interpreted
from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.library import Call
from minirt.rendering.frame import frame_arguments
from minirt.rendering.packing.features import DEPTH, SPREAD, features, primitive_count, shape_features
from minirt.rendering.packing.generic_kernels import FULL_DOUBLE, GenericKernel, empty_arrays
from minirt.rendering.packing.visibility import SMALL
from minirt.rendering.sampling.contrast import classify_call
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene, parse


def kernel_features(scene: Scene) -> frozenset[Hashable]:
    """The kinds of shapes and the features of a scene, each set of which has a kernel of its own.

    With light sources that are not points "bvh" is one of them where there are so many shapes that shadow rays traverse
    a BVH.
    """
    used = features(scene)
    return used | {"bvh"} if primitive_count(scene) > SMALL and not SPREAD.isdisjoint(used) else used


def minimal_scene(scene: Scene) -> Scene:
    """Return a scene of few shapes that needs the same kernel, to compile it for."""
    examples = {(type(shape), *shape_features(shape)): shape for shape in scene.shapes}.values()
    shapes = [shape.some(np.arange(1)) for shape in examples]
    more = min(primitive_count(scene), SMALL + 1) - len(shapes)
    background = (scene.background,) if scene.background else ()
    return Scene((scene.camera, *background, *scene.lights, *shapes, *shapes[:1] * more), scene.file)


# With so many shapes parallel light needs a BVH.
EXAMPLE = "A 1 255,255,255\nC 0,0,-9 0,0,1 60\ndl 0,-1,0 1 255,255,255\n" + "sp 0,0,0 1 255,255,255\n" * 9
PIXEL = np.zeros((1, 1, 4), np.uint8)


def calls_for(scene: Scene, precision: str, depth: int) -> list[Call]:
    """Return calls of the kernels for a scene: of those that pack it and that find contrast, and of the specialised
    one that draws it."""
    recorder = CallRecorder()
    with np.errstate(all="ignore"):  # as the compiled functions do, which are interpreted here
        arrays = Packing(recorder, precision, depth).pack(minimal_scene(scene), 1, 1)
    return [*recorder.calls.values(), classify_call(), functions.frame.call(*frame_arguments(arrays, PIXEL))]


def generic_call(generic: GenericKernel) -> Call:
    """Return a call of a generic kernel."""
    return functions.frame.call(*frame_arguments(empty_arrays(generic), PIXEL))


def packing_calls() -> list[Call]:
    """Return calls of all functions beside those that draw, whose types are the same for all scenes."""
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
