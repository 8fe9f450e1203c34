"""Key of the compiled kernels: what decides which kernel renders a scene, and a small scene that needs the same one."""

from __future__ import annotations

from collections.abc import Hashable

import numpy as np

from minirt.rendering.culling.visibility import SMALL
from minirt.rendering.packing.features import SPREAD, features, primitive_count, shape_features
from minirt.scene import Scene


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
