"""Generic kernels draw the same bits as the specialised kernel of each scene, and all scenes have the types of one."""

from __future__ import annotations

from random import Random
from typing import Any

import numpy as np
import pytest
from numba import typeof

import minirt
from minirt.kernel import functions
from minirt.kernel.scene_arrays import SceneArrays
from minirt.materials import Checker, Specular
from minirt.rendering.frame import frame_arguments
from minirt.rendering.packing.generic_kernels import GENERIC_KERNELS, GenericKernel, empty_arrays, fitting, generalised
from minirt.rendering.scene_packing import Packing
from minirt.scene import Background, ParallelLight, Scene, SpotLight
from minirt.shapes import Plane, Sphere
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, WHITE
from tests.make_goldens import SCENES
from tests.meshes.examples import soup
from tests.paths import SCENES as SCENES_FOLDER
from tests.random_scenes import random_scene
from tests.seeds import seed_of

PRECISIONS = ("double", "single")
SUN = ParallelLight((0.3, -0.9, 0.2), 0.3)
BALLS = tuple(Sphere((i - 5, 0.5 * (i % 3), i % 4), 1.5, (200, 20 * i, 90)) for i in range(12))
FLOOR = Plane((0, -1, 0), (0, 1, 0), WHITE)


def packed(scene: Scene, precision: str = "double", depth: int = 8, width: int = 96, height: int = 72) -> SceneArrays:
    """Return the arrays of a scene for its specialised kernel."""
    return Packing(precision=precision, depth=depth).pack(scene, width, height)


def drawn(arrays: SceneArrays, samples: int = 1, width: int = 96, height: int = 72) -> tuple[np.ndarray, np.ndarray]:
    """Return the pixels and the linear light that the kernel for the types of some arrays draws."""
    pixels, light = np.zeros((height, width, 4), np.uint8), np.full((height, width, 3), np.nan)
    arguments = frame_arguments(arrays, pixels, samples, light)
    functions.frame(*arguments)
    return pixels, light


def same_bits(one: SceneArrays, other: SceneArrays, samples: int = 1) -> bool:
    """Whether the kernels of two forms of a scene draw the same pixels and the same light, to the last bit."""
    results = zip(drawn(one, samples), drawn(other, samples), strict=True)
    return all(a.tobytes() == b.tobytes() for a, b in results)


def every_form(scene: Scene) -> list[tuple[SceneArrays, GenericKernel]]:
    """Return a packed scene in each precision, with each generic kernel that fits it."""
    forms = {arrays.camera.dtype: arrays for arrays in (packed(scene, precision) for precision in PRECISIONS)}
    return [(arrays, generic) for arrays in forms.values() for generic in fitting(arrays)]


SINGLE = [SCENES_FOLDER / f"{stem}.rt" for stem in ("demo", "shapes", "meshes", "figure-v4-everything", "light-spot")]


# Each run compiles kernels of other scenes than the run before.
CHANCE = Random(seed_of("generic kernels"))
SOME = (CHANCE.choice(SCENES), "double"), (CHANCE.choice(SINGLE), "single")


@pytest.mark.parametrize("number", range(len(SOME)))
def test_generic_kernels_draw_the_same_bits_as_the_specialised_one(number: int) -> None:
    path, precision = SOME[number]
    arrays = packed(minirt.load(path), precision)
    generic_kernels = fitting(arrays)
    assert (generic_kernels[-1].name, generic_kernels[-1].precision) == ("full", precision)
    for generic in generic_kernels:
        assert same_bits(arrays, generalised(arrays, empty_arrays(generic))), (path, generic)


SPECIAL = {
    "no lights, planes only": Scene((AMBIENT, EYE, FLOOR, Plane((0, 0, 9), (0, 0.1, -1), WHITE))),
    "a mesh and parallel light": Scene((AMBIENT, EYE, LAMP, SUN, soup(np.random.default_rng(1), 100_000, 0.2), FLOOR)),
    "parallel light, a BVH, mirrors and a background": Scene(
        (AMBIENT, EYE, SUN, LAMP, Background((9, 40, 90)), *BALLS, FLOOR.replace(mirror=0.4))
    ),
}


@pytest.mark.parametrize("name", SPECIAL)
def test_special_scenes_have_the_same_bits(name: str) -> None:
    arrays = packed(SPECIAL[name])
    for generic in fitting(arrays):
        assert same_bits(arrays, generalised(arrays, empty_arrays(generic))), generic


@pytest.mark.parametrize("scenes", ["files", "random", "special"])
def test_all_scenes_have_the_types_of_the_empty_one(scenes: str) -> None:
    several = {
        "files": lambda: [minirt.load(path) for path in SCENES],
        "random": lambda: [random_scene(seed) for seed in range(12)],
        "special": lambda: list(SPECIAL.values()),
    }[scenes]()
    for scene in several:
        for arrays, generic in every_form(scene):
            assert typeof(generalised(arrays, empty_arrays(generic))) == typeof(empty_arrays(generic))


def test_the_most_specialised_kernel_comes_first() -> None:
    def names(*changes: Any, precision: str = "double") -> list[str]:
        return [generic.name for generic in fitting(packed(Scene((AMBIENT, EYE, LAMP, *changes)), precision))]

    spot = SpotLight((0, 7, -3), (0, -1, 0.3), 50, 0.8)
    for precision in PRECISIONS:
        assert names(*BALLS, FLOOR, precision=precision) == ["plain", "full"]
        for shape in (FLOOR.replace(checker=Checker(0.5)), FLOOR.replace(specular=Specular(0.5, 9))):
            assert names(*BALLS, shape, precision=precision) == ["full"]
        assert names(spot, *BALLS, precision=precision) == ["full"]
        assert names(FLOOR.replace(mirror=0.5), precision=precision) == ["full"]
    assert all(generic.precision == "single" for generic in fitting(packed(ALL, "single")))


def test_generalising_copies_nothing() -> None:
    for scene in (SPECIAL[name] for name in SPECIAL if name != "no lights, planes only"):
        arrays = packed(scene)
        generic = generalised(arrays, empty_arrays(fitting(arrays)[-1]))
        for name in ("slots", "cones", "light_cones", "colours_and_extents", "tile_shapes", "light_shapes", "lights"):
            assert getattr(generic, name) is getattr(arrays, name)
        assert sum(len(group.rows) for group in generic.groups) == len(arrays.slots)
        for group in arrays.groups:
            assert any(each is group for each in generic.groups)
        if arrays.bvh:
            assert generic.bvh.nodes is arrays.bvh.nodes
            assert {id(group) for group in arrays.bvh.groups} <= {id(group) for group in generic.bvh.groups}


def test_every_feature_has_a_generic_kernel() -> None:
    optional = [name for name, default in SceneArrays._field_defaults.items() if default is None]
    double = [generic for generic in GENERIC_KERNELS if generic.precision == "double"]
    assert double[-1].features == {*optional, "checks", "textures", "bumps", "normals", "placements"}
