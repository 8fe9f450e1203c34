"""Rays that start on slivers do not hit them again, and the light on slivers is right."""

from __future__ import annotations

import numpy as np
import pytest

import minirt
from minirt.fields import MeshFile
from minirt.meshes import Triangles
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Mesh, Triangle
from tests.kernel.pictures import linear
from tests.shapes.examples import shadow_offsets
from tests.shapes.regimes import GREY, Array, Random, log_uniform, random_directions, random_perpendiculars, unit

ASPECTS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-12)  # height by longest edge
SCALES = (1e-6, 1e-3, 1.0, 60.0, 1e4, 1e9)  # longest edge
WHITE = (255, 255, 255)
AMBIENT = 0.25


def sliver(random: Random, aspect: float, scale: float) -> Triangle:
    """A triangle about the origin, its corners in any order and its highest point anywhere above the longest edge."""
    along = scale * random_directions(random)
    foot = random.uniform(0, 1) * along
    corners = np.array([0 * along, along, foot + aspect * scale * random_perpendiculars(random, along)])
    corners += random.uniform(-1, 0) * along
    return Triangle(*map(tuple, random.permutation(corners).tolist()), GREY)


def corners_of(triangle: Triangle) -> Array:
    return np.array([triangle.a, triangle.b, triangle.c])


def mesh_of(triangles: list[Triangle]) -> Mesh:
    """A mesh of triangles that share no corners."""
    points = np.concatenate([corners_of(each) for each in triangles])
    return Mesh(MeshFile("slivers.obj", Triangles(points, np.arange(len(points)).reshape(-1, 3))), (0, 0, 0), 1.0, GREY)


def scene_of(random: Random, aspect: float, scale: float) -> tuple[Scene, float]:
    """A mesh of one sliver, seen from as near as the sliver is high, and its light: ambient and diffuse."""
    shape = sliver(random, aspect, scale)
    normal = np.array(shape.normal()) * random.choice([-1.0, 1.0])
    spot = random.dirichlet(np.full(3, 4.0)) @ corners_of(shape)
    view = unit(-normal + 0.5 * random_directions(random))
    eye = Camera(tuple(spot - aspect * scale * view), tuple(view.clip(-1, 1)), 50)
    cosine = random.uniform(0.05, 1)
    to_light = cosine * normal + np.sqrt(1 - cosine**2) * random_perpendiculars(random, normal)
    light = Light(tuple(spot + 1e4 * scale * to_light), 0.5, WHITE)
    drawn = mesh_of([shape]).replace(colour=WHITE)
    return Scene((Ambient(AMBIENT, WHITE), eye, light, drawn)), AMBIENT + 0.5 * cosine


COUNT = 64
ASPECT = pytest.mark.parametrize("aspect", ASPECTS)


@ASPECT
def test_no_ray_hits_the_sliver_of_a_mesh_again_from_which_it_starts(aspect: float) -> None:
    for seed, scale in enumerate(SCALES):
        random = np.random.default_rng(seed)
        made = sliver(random, aspect, scale)
        scene = Scene((Camera((0, 0, 0), (0, 0, 1), 60), mesh_of([made])))
        targets = random.dirichlet(np.ones(3), COUNT) @ corners_of(made)
        directions = random_directions(random, COUNT)
        found = minirt.trace(scene, targets - scale * directions, directions)
        hit = np.isfinite(found.distance)
        assert hit.sum() > 0.9 * COUNT
        on, out = found.point[hit], found.normal[hit]
        out = np.where((out * directions[hit]).sum(axis=-1, keepdims=True) > 0, -out, out)
        onwards = unit(
            log_uniform(random, 1e-10, 1, len(out), 1) * out + np.cross(out, random_directions(random, len(out)))
        )
        again = minirt.trace(scene, on + shadow_offsets(on[None], [made])[0] * out, onwards)
        assert np.isinf(again.distance).all()


@ASPECT
def test_the_slivers_of_meshes_are_lit(aspect: float) -> None:
    for seed, scale in enumerate(SCALES):
        scene, light = scene_of(np.random.default_rng(seed), aspect, scale)
        found = linear(scene)[..., 0]
        seen = found >= AMBIENT / 2
        assert seen.sum() > 20
        assert np.abs(found[seen] - light).max() < 1e-3
