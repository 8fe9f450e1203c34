"""A kernel has no code for features and kinds of shapes that its scene lacks."""

from __future__ import annotations

import sys
from functools import cache
from typing import Any

import numpy as np
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel.compiler.object_code import type_of
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.kernel.frame import frame
from minirt.kernel.machine_code.arguments import signature_of
from minirt.lanes.mathematics import ATAN_HALF, PERIOD
from minirt.materials import Checker, Clouds
from minirt.rendering.frame import frame_arguments
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import AMBIENT, EYE, LAMP, SHAPES, linear
from tests.processes import run

ROOT = "call <16 x double> @llvm.sqrt.v16f64"


def scene_of(*kinds: type[Any]) -> Scene:
    """Return a scene with all test shapes of some kinds."""
    return Scene((AMBIENT, EYE, LAMP, *(shape for shape in SHAPES if isinstance(shape, kinds))))


@cache
def code(scene: Scene) -> str:
    """Return the LLVM code of the kernel of a scene, compiled anew: a kernel from the cache shows none."""
    arguments = frame_arguments(Packing().pack(scene, 8, 8), np.zeros((8, 8, 4), np.uint8))
    kernel = njit(**FLAGS)(frame)
    signature = tuple(type_of(signature_of(each)) for each in arguments)
    kernel.compile(signature)
    return str(kernel.inspect_llvm(signature))


def test_only_shapes_that_take_square_roots_add_them() -> None:
    planes, spheres, cylinders = (
        code(scene_of(*kinds)).count(ROOT) for kinds in ((Plane,), (Sphere,), (Sphere, Cylinder))
    )
    assert planes < spheres < cylinders


def size_without(*titles: str) -> int:
    """Count the lines of LLVM code of the kernel of spheres if the package has no shapes of these titles."""
    program = f"""
from minirt import shapes
shapes.KINDS = tuple(kind for kind in shapes.KINDS if kind.element.title not in {titles})
from minirt.shapes.sphere import Sphere
from tests.kernel.compiler.test_specialisation import code, scene_of
print(code(scene_of(Sphere)).count(chr(10)))
"""
    ended = run([sys.executable, "-c", program], text=True)
    assert ended.returncode == 0, ended.stderr
    return int(ended.stdout)


def test_kinds_of_shapes_that_the_scene_lacks_do_not_change_the_kernel() -> None:
    assert code(scene_of(Sphere)).count("\n") == size_without("plane", "cylinder") > 1000


def test_texture_coordinates_are_computed_for_textured_scenes_only() -> None:
    plain = scene_of(Sphere, Cylinder)
    checkered = Scene((*plain.elements[:-1], plain.elements[-1].replace(checker=Checker(0.5))))
    constant = f"0x{np.float64(ATAN_HALF).view(np.uint64):X}"
    assert constant not in code(plain)
    assert constant in code(checkered)


def test_noise_is_computed_for_scenes_with_patterns_only() -> None:
    plain = scene_of(Sphere)
    patterned = Scene((*plain.elements[:-1], plain.elements[-1].replace(clouds=Clouds(1.0))))
    constant = f"0x{np.float64(1.0 / PERIOD).view(np.uint64):X}"
    assert constant not in code(plain)
    assert constant in code(patterned)


def test_shapes_out_of_sight_change_nothing() -> None:
    behind = [Sphere((9 * i, 0, -900), 3, (1, 2, 3)) for i in range(20)]
    scene = scene_of(Plane, Sphere)
    more = Scene((*scene.elements, *behind))
    assert np.array_equal(linear(more, 60, 40), linear(scene, 60, 40))
