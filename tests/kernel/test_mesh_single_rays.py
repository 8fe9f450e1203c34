"""Single rays through the trees of meshes: no triangle that a ray hits is left out, and the closest one is found."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import minirt
from minirt import Camera, Scene
from minirt.fields import MeshFile
from minirt.kernel import bvh_rays, interpreted, mesh_rays
from minirt.kernel.bvh_nodes import DIRECTION, HIT, ORIGIN, WIDTH, packet_memory
from minirt.kernel.scene_arrays import Group
from minirt.lanes import Vec, save_vec
from minirt.rendering.packing.mesh_trees import mesh_trees, place_meshes
from minirt.rendering.packing.ray_casting import nearest_hits
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import Mesh, Sphere
from tests.kernel.test_beams import SEED, Packet, hits, packet
from tests.meshes.examples import GREY, ball, soup
from tests.shapes.regimes import random_directions


def visited(rays: Packet, reach: float = np.inf) -> np.ndarray:
    """Return which triangles each ray of a packet visits, up to a distance: (16, triangles)."""
    mesh, eye, directions = rays
    arrays = ShapeArrays()
    arrays.update((mesh, mesh.replace(scale=2 * mesh.scale)))
    trees, triangles = mesh_trees(arrays, interpreted), place_meshes(arrays, interpreted)
    memory, found = packet_memory(), np.zeros((WIDTH, mesh.parts), bool)
    save_vec(Vec(*(np.full(WIDTH, part) for part in eye)), memory, ORIGIN)
    save_vec(Vec(*directions), memory, DIRECTION)
    memory[HIT : HIT + WIDTH] = reach

    def visit(group: Any, row: int, index: int, memory: Any, ray: int) -> None:
        assert row == index < mesh.parts
        found[ray, index] = True

    group = Group(arrays.tables[0], None, None, 0, trees, triangles)
    with np.errstate(all="ignore"):
        mesh_rays.triangles_along(visit, group, 0, memory, (1 << WIDTH) - 1)
    return found


def test_a_ray_visits_all_triangles_that_it_hits() -> None:
    for seed in range(SEED, SEED + 24):
        rays = packet(seed)
        missing = hits(rays) & ~visited(rays)
        assert not missing.any(), f"seed {seed}: {np.argwhere(missing)[:3].tolist()} are left out"


@pytest.mark.parametrize(
    ("module", "margin", "value"),
    [(mesh_rays, "ROUNDING", -1e-2), (bvh_rays, "ROUNDING", -2.0), (bvh_rays, "MARGIN", -0.1)],
)
def test_a_ray_with_too_small_a_margin_is_found_out(
    monkeypatch: pytest.MonkeyPatch, module: Any, margin: str, value: float
) -> None:
    monkeypatch.setattr(module, margin, value)
    assert any((hits(packet(seed)) & ~visited(packet(seed))).any() for seed in range(12))


def test_a_ray_visits_few_triangles_and_none_behind_its_end() -> None:
    mesh = Mesh(MeshFile("ball.obj", ball(3)), (1.0, 2.0, 3.0), 2.0, GREY)
    directions = np.array([[0.0], [0.0], [1.0]]) + 1e-4 * np.random.default_rng(1).normal(size=(3, 16))
    rays = Packet(mesh, np.array([1.01, 2.01, -5.0]), directions / np.linalg.norm(directions, axis=0))
    through, near, none = (visited(rays, reach).sum(axis=1) for reach in (np.inf, 7.0, 5.9))
    assert (through >= 2).all()
    assert through.max() <= 6
    assert (through > near).all()
    assert (near > 0).all()
    assert not none.any()


@pytest.mark.parametrize("regime", [(1.0, 0.0), (1e-5, 0.0), (1e4, 0.0), (1.0, 1e4), (1e-2, 1e6)])
@pytest.mark.parametrize("is_coherent", [False, True])
def test_rays_of_any_origin_hit_the_closest_triangle(regime: tuple[float, float], is_coherent: bool) -> None:
    """Among several meshes and a ball, those that `nearest_hits` finds by trying all."""
    random = np.random.default_rng(SEED)
    scale, away = regime
    middle = away * random_directions(random, 1)[0]
    shapes: list[Any] = [
        soup(random, 150).replace(position=tuple((middle + 3 * scale * random.normal(size=3)).tolist()), scale=scale)
        for _ in range(3)
    ]
    shapes.append(Sphere(tuple(middle.tolist()), scale, GREY))
    shapes.append(shapes[0].replace(axis=(0.6, 0.0, 0.8), scale=2 * scale))
    origins = middle + 8 * scale * random.normal(size=(1600, 3))
    directions = middle + scale * random.normal(size=(1600, 3)) - origins
    if is_coherent:
        origins = np.repeat(origins[::WIDTH], WIDTH, axis=0)
        directions = np.repeat(directions[::WIDTH], WIDTH, axis=0) + 0.3 * scale * random.normal(size=(1600, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    arrays = ShapeArrays()
    arrays.update(tuple(shapes))
    distance, primitive = nearest_hits(arrays, Vec(*origins.T), Vec(*directions.T))
    found = minirt.trace(Scene([Camera((0, 0, -9), (0, 0, 1), 60), *shapes]), origins, directions)
    hit = primitive >= 0
    assert hit.mean() > 0.2  # all, with some seeds
    assert np.array_equal(found.owner, np.where(hit, arrays.owner[primitive], -1))
    assert np.allclose(found.distance[hit], distance[hit], rtol=1e-9, atol=0)
