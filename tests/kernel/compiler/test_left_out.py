"""What a scene does not need is not in its kernel."""

from __future__ import annotations

import sys
from functools import cache
from typing import Any

import numpy as np
import pytest

from minirt.kernel.compiler import jit
from minirt.kernel.compiler.compilation import compiled
from minirt.lanes.angle import ATAN_HALF
from minirt.materials import Checker
from minirt.rendering import Renderer
from minirt.scene import Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import AMBIENT, EYE, LAMP, SHAPES, linear
from tests.processes import run

ROOT = "call <16 x double> @llvm.sqrt.v16f64"


def of(*kinds: type[Any]) -> Scene:
    return Scene((AMBIENT, EYE, LAMP, *(shape for shape in SHAPES if isinstance(shape, kinds))))


@cache
def code(scene: Scene) -> str:
    """The kernel of a scene, compiled here and now: what is kept from other runs shows no LLVM code."""
    kernel = compiled(jit.frame.frame, None)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(jit, "kernel_for", lambda traced: kernel)
        Renderer(1).render(scene, np.zeros((8, 8, 4), np.uint8))
    (signature,) = kernel.signatures
    return str(kernel.inspect_llvm(signature))


def test_square_roots_come_with_the_shapes_that_take_them() -> None:
    planes, balls, tubes = (code(of(*kinds)).count(ROOT) for kinds in ((Plane,), (Sphere,), (Sphere, Cylinder)))
    assert planes < balls < tubes


def size_without(*titles: str) -> int:
    """Lines of LLVM code of the kernel of spheres where the package has no shapes of these titles."""
    program = f"""
from minirt import shapes
shapes.KINDS = tuple(kind for kind in shapes.KINDS if kind.element.title not in {titles})
from minirt.shapes.sphere import Sphere
from tests.kernel.compiler.test_left_out import code, of
print(code(of(Sphere)).count(chr(10)))
"""
    ended = run([sys.executable, "-c", program], text=True)
    assert ended.returncode == 0, ended.stderr
    return int(ended.stdout)


def test_a_kernel_does_not_change_with_the_kinds_of_shapes_that_there_are() -> None:
    assert code(of(Sphere)).count("\n") == size_without("plane", "cylinder") > 1000


def test_coordinates_of_pictures_come_with_what_is_painted() -> None:
    plain = of(Sphere, Cylinder)
    painted = Scene((*plain.elements[:-1], plain.elements[-1].replace(checker=Checker(0.5))))
    constant = f"0x{np.float64(ATAN_HALF).view(np.uint64):X}"
    assert constant not in code(plain)
    assert constant in code(painted)


def test_shapes_that_are_not_seen_change_nothing() -> None:
    behind = [Sphere((9 * i, 0, -900), 3, (1, 2, 3)) for i in range(20)]
    scene = of(Plane, Sphere)
    more = Scene((*scene.elements, *behind))
    assert np.array_equal(linear(more, 60, 40), linear(scene, 60, 40))
