"""Beams of rays through the trees of meshes: no triangle that a ray meets is left out, and few others are visited."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

from minirt.fields import MeshFile
from minirt.kernel import beam_traversal, beams, bvh_nodes, interpreted
from minirt.kernel.scene_arrays import Group
from minirt.lanes import Vec
from minirt.meshes import Triangles
from minirt.rendering.packing.mesh_trees import mesh_trees, place_meshes
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import MESH, Mesh
from tests.meshes.examples import GREY, ball, soup
from tests.seeds import seed_of
from tests.shapes.regimes import random_directions

SEED = seed_of("beams")  # each run has other meshes and rays
LANES = {np.float64: 16, np.float32: 32}


class Packet(NamedTuple):
    """A mesh with a second one behind it in the arrays, the eye, and directions of rays, (3, lanes)."""

    mesh: Mesh
    eye: np.ndarray
    directions: np.ndarray


def packet(seed: int) -> Packet:
    """Make a mesh of any place, size and turn, an eye in it, near it or far away, and rays side by side or apart."""
    chance = np.random.default_rng(seed)
    triangles = soup(chance, 150, chance.choice([0.1, 1.0])).triangles if chance.random() < 0.6 else ball(3)
    scale = 10.0 ** chance.uniform(-6, 6)
    position = scale * chance.choice([0.0, 1.0, 1e6]) * chance.normal(size=3)
    axis = (0.0, 1.0, 0.0) if chance.random() < 0.3 else tuple(random_directions(chance, 1)[0].tolist())
    mesh = Mesh(MeshFile("x.obj", triangles), tuple(position.tolist()), scale, GREY, axis=axis)
    eye = mesh.position + scale * chance.choice([0.0, 1.0, 5.0, 1e4]) * chance.normal(size=3)
    corners = mesh.rows()[:, :9].reshape(-1, 3, 3)
    target = corners[chance.integers(len(corners))].mean(axis=0) - eye
    width = np.linalg.norm(target) * chance.choice([1e-3, 0.05, 1.0, 5.0])
    aims = target + width * chance.normal(size=(16, 3))
    aims[:4] = corners[chance.integers(len(corners), size=4), 0] - eye  # exactly at corners
    return Packet(mesh, eye, (aims / np.linalg.norm(aims, axis=1)[:, None]).T)


def visited(rays: Packet, number: type = np.float64, own: int = -1) -> np.ndarray:
    """Return which triangles beams around the rays of a packet, which start on one of their `own`, visit for each ray:
    (lanes, triangles)."""
    mesh, eye, directions = rays
    arrays = ShapeArrays()
    arrays.update((mesh, mesh.replace(scale=2 * mesh.scale)))
    trees = mesh_trees(arrays, interpreted)
    if number is np.float32:
        trees.places[:, bvh_nodes.CENTRE : bvh_nodes.FACTOR] -= eye
        trees, eye = trees._replace(places=trees.places.astype(np.float32)), np.zeros(3)
    lanes = LANES[number]
    way = Vec(*np.tile(directions, lanes // 16).astype(number))
    found = np.zeros((lanes, mesh.parts), bool)

    def visit(group: Any, row: int, index: int, within: Any, state: None, data: Any) -> None:
        assert row == index < mesh.parts
        found[within, index] = True

    def reach(state: None, data: Any) -> np.ndarray:
        return np.full(lanes, np.inf)

    apexes = Vec(*(np.full(lanes, part, number) for part in eye))
    group = Group(arrays.rows[0], None, None, 0, trees, place_meshes(arrays, interpreted))
    active = np.ones(lanes, bool)
    starts = apexes, way, np.full(lanes, own, number)
    beam_traversal.fold_over_mesh(visit, reach, group, 0, starts, active, None, None)
    return found


def hits(rays: Packet) -> np.ndarray:
    """Return which triangles the rays hit: (16, triangles)."""
    packed = rays.mesh.pack()
    with np.errstate(all="ignore"):
        return np.array([MESH.intersect(packed, Vec(*rays.eye), Vec(*one))[0] for one in rays.directions.T])


@pytest.mark.parametrize("number", [np.float64, np.float32])
def test_a_beam_visits_all_triangles_that_its_rays_hit(number: type) -> None:
    for seed in range(SEED, SEED + 24):
        rays = packet(seed)
        with np.errstate(all="ignore"):
            found = visited(rays, number)
        missing = hits(rays) & ~found[:16]
        assert not missing.any(), f"seed {seed}: {np.argwhere(missing)[:3].tolist()} are left out"


def test_a_beam_that_is_too_narrow_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(beams, "ROUNDING", -1e-2)
    with np.errstate(all="ignore"):
        assert any(np.array([(hits(packet(seed)) & ~visited(packet(seed))).any() for seed in range(12)]))


def test_a_narrow_beam_visits_few_triangles_and_none_behind_the_eye() -> None:
    mesh = Mesh(MeshFile("ball.obj", ball(3)), (1.0, 2.0, 3.0), 2.0, GREY)
    directions = np.array([[0.0], [0.0], [1.0]]) + 1e-4 * np.random.default_rng(1).normal(size=(3, 16))
    packets = [Packet(mesh, np.array([1.01, 2.01, z]), directions) for z in (-5.0, 3.0, 9.0)]
    outside, inside, beyond = (visited(rays)[0].sum() for rays in packets)
    assert 0 < inside < outside <= 4
    assert beyond == 0
    own = int(np.flatnonzero(visited(packets[1])[0])[0])
    assert visited(packets[1], own=own)[0].sum() == inside - 1, "a ray met the triangle that it starts on"


def test_moving_turning_and_scaling_a_mesh_keeps_its_tree() -> None:
    one = Mesh(MeshFile("x.obj", Triangles(ball(3).points, ball(3).corners)), (0.0, 0.0, 0.0), 1.0, GREY)
    packed = []
    for mesh in (one, one.replace(position=(1.0, 2.0, 3.0)), one.replace(scale=3.0, axis=(1.0, 0.0, 0.0))):
        arrays = ShapeArrays()
        arrays.update((mesh,))
        packed.append(mesh_trees(arrays, interpreted).nodes)
    assert packed[0] is packed[1] is packed[2]
