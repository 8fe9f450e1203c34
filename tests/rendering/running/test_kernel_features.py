"""Kernels: which scenes share one, and the minimal scene that it is compiled for."""

from __future__ import annotations

import pytest

from minirt.kernel.machine_code.library import LIBRARY
from minirt.materials import Checker
from minirt.rendering import Renderer
from minirt.rendering.culling.visibility import SMALL
from minirt.rendering.running.kernel_features import kernel_features, minimal_scene
from minirt.scene import Ambient, Light, ParallelLight, Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.mesh import Mesh
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import ALL, EYE, SHAPES
from tests.meshes.examples import GREY, named

LIGHT = Ambient(0.2, GREY)
BALL = Sphere((0, 0, 0), 1, GREY)
SUN = ParallelLight((0, -1, 0), 0.5)


def test_a_kernel_is_ready_for_all_scenes_of_its_kinds(monkeypatch: pytest.MonkeyPatch) -> None:
    renderer, there = Renderer(1), set[str]()
    monkeypatch.setattr(LIBRARY, "has", there.__contains__)
    assert renderer.is_ready(Scene((EYE,)))
    assert not renderer.is_ready(ALL)
    there.update(renderer.kernels.specialised(ALL))
    assert renderer.is_ready(ALL)
    assert renderer.is_ready(Scene((EYE, *SHAPES[:3])))
    assert not renderer.is_ready(Scene((EYE, SHAPES[0])))
    there.update(renderer.kernels.for_all_scenes)
    assert renderer.is_ready(Scene((EYE, SHAPES[0])))
    assert kernel_features(ALL) == {type(shape) for shape in SHAPES}


def test_the_minimal_scene_needs_the_same_kernel() -> None:
    balls = [Sphere((i, 0, 0), 1, GREY, mirror=0.5 if i == 70 else None) for i in range(100)]
    tube = Cylinder((0, 0, 0), (0, 1, 0), 1, 2, GREY, checker=Checker(0.1))
    for elements in ((BALL,), (*balls, tube, SUN), (*balls[: SMALL + 1], SUN), (BALL, SUN)):
        scene = Scene((LIGHT, EYE, *elements))
        assert kernel_features(minimal_scene(scene)) == kernel_features(scene)
        assert len(minimal_scene(scene).shapes) <= SMALL + 2
    assert "bvh" in kernel_features(Scene((LIGHT, EYE, *balls, SUN)))
    assert "bvh" not in kernel_features(Scene((LIGHT, EYE, *balls)))


def test_the_minimal_scene_of_a_large_mesh_is_small() -> None:
    scene = Scene((EYE, Light((5, 8, -9), 0.9), named("knot"), Sphere((0, 3, 0), 1, GREY), named("pot")))
    small = minimal_scene(scene)
    assert {type(shape) for shape in small.shapes} == {Mesh, Sphere}
    assert sum(shape.parts for shape in small.shapes) < 20
