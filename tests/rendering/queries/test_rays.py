"""Closest-hit queries of the library, compared with 50-digit arithmetic."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.kernel.machine_code.library import LIBRARY
from minirt.rendering import scene_packing
from minirt.rendering.queries import certificates
from minirt.scene import Scene
from minirt.shapes import Cylinder, Plane, Sphere
from tests import oracle
from tests.kernel.bvh.test_bvh import random_rays, random_shapes
from tests.kernel.pictures import AMBIENT, EYE, RED
from tests.processes import run

FLOOR = Plane((0, -1, 0), (0, 1, 0), RED)
BALL = Sphere((0, 0, 5), 2, RED)
COLUMN = Cylinder((4, 0, 0), (0, 1, 0), 2, 6, RED)


def scene(*shapes: Any) -> Scene:
    return Scene((AMBIENT, EYE, *shapes))


def test_rays_hit_at_the_expected_distances_points_and_normals() -> None:
    hits = minirt.trace(
        scene(BALL, FLOOR, COLUMN),
        [[0, 0, 0], [0, 0, 5], [0, 3, 0], [0, 0, 0], [0, 0, 0], [4, 9, 0]],
        [[0, 0, 1], [0, 1, 0], [0, -2, 0], [0, 1, 0], [3, 0, 0], [0, -1, 0]],
    )
    assert hits.distance.tolist() == [4, 1, 4, np.inf, 3, 6]
    assert hits.owner.tolist() == [0, 0, 1, -1, 2, 2]
    assert hits.owner.dtype == np.int64
    nan = [np.nan] * 3
    assert np.array_equal(hits.point, [[0, 0, 4], [0, 1, 5], [0, -1, 0], nan, [3, 0, 0], [4, 3, 0]], equal_nan=True)
    # Outward, also where the ray comes from inside.
    assert np.array_equal(hits.normal, [[0, 0, -1], [0, 1, 0], [0, 1, 0], nan, [-1, 0, 0], [0, 1, 0]], equal_nan=True)


def test_rays_hit_as_in_exact_arithmetic() -> None:
    random = np.random.default_rng(8)
    shapes = random_shapes(random, 30)
    origins, directions = random_rays(random, shapes, 120)
    hits = minirt.trace(scene(*shapes), origins, directions)
    assert (hits.owner >= 0).mean() > 0.2
    for i, (origin, direction) in enumerate(zip(origins, directions, strict=True)):
        exact = [oracle.nearest(shape, origin, direction) for shape in shapes]
        right = min((t * np.linalg.norm(direction), index) for index, t in enumerate([*exact, np.inf]))
        if np.isinf(right[0]):
            assert (hits.distance[i], hits.owner[i]) == (np.inf, -1)
            continue
        assert hits.owner[i] == right[1]
        assert hits.distance[i] == pytest.approx(right[0], rel=1e-12)
        assert np.allclose(hits.point[i], origin + hits.distance[i] * direction, atol=1e-12 * (1 + right[0]))
        assert np.linalg.norm(hits.normal[i]) == pytest.approx(1, abs=1e-15)


def test_there_may_be_no_rays_no_shapes_and_one_ray() -> None:
    none = minirt.trace(scene(BALL), np.zeros((0, 3)), np.zeros((0, 3)))
    assert [part.shape for part in none] == [(0,), (0,), (0, 3), (0, 3)]
    assert minirt.trace(scene(), [[0, 0, 0]], [[0, 0, 1]]).owner.tolist() == [-1]
    assert minirt.trace(scene(FLOOR), [[0, 0, 0]], [[0, -1, 0]]).owner.tolist() == [0]


def test_the_arguments_may_have_any_type_and_memory_layout(monkeypatch: pytest.MonkeyPatch) -> None:
    """They do not need kernels of their own."""
    used = set[str]()
    origins, directions = np.zeros((40, 3), np.float32), np.tile([0.0, 0, 1], (40, 1))
    fixed = directions.copy()
    fixed.flags.writeable = False
    orders = [directions.tolist(), fixed, np.asfortranarray(directions), np.repeat(directions, 2, axis=0)[::2]]
    kernels = set[str]()
    monkeypatch.setattr(LIBRARY, "find", lambda identity, find=LIBRARY.find: kernels.add(identity) or find(identity))
    for each in orders:
        assert (minirt.trace(scene(BALL, FLOOR), origins, each).distance == 4).all()
        used = used or kernels.copy()
        assert kernels == used
    assert any("trace_rays" in each for each in used)


GOOD = np.ones((4, 3))


@pytest.mark.parametrize(
    ("origins", "directions", "message"),
    [
        (np.ones(3), GOOD, r"origins must have the shape \(n, 3\), got \(3,\)"),
        (GOOD, np.ones((4, 2)), r"directions must have the shape \(n, 3\), got \(4, 2\)"),
        (GOOD, np.ones((5, 3)), "directions must be as many as origins, 4, got 5"),
        (GOOD * np.nan, GOOD, "origins must be finite, got nan"),
        (GOOD, GOOD * np.inf, "directions must be finite, got inf"),
        (GOOD, [[1, 0, 0], [0, 0, 1], [0, -0.0, 0], [0, 1, 0]], "directions must not be 0,0,0, got it at 2"),
        (GOOD, "up", r"directions must be numbers of shape \(n, 3\)"),
        ([[1, 2], [3]], GOOD, r"origins must be numbers of shape \(n, 3\)"),
        (GOOD * 1j, GOOD, r"origins must be numbers of shape \(n, 3\)"),
    ],
)
def test_an_error_names_the_argument(origins: Any, directions: Any, message: str) -> None:
    for shapes in ((), (BALL,)):
        with pytest.raises(ValueError, match=f"^{message}"):
            minirt.trace(scene(*shapes), origins, directions)


def test_one_thread_and_many_give_the_same_bits() -> None:
    random = np.random.default_rng(3)
    shapes = random_shapes(random, 300)
    many = random_rays(random, shapes, 10_007)
    one = minirt.trace(scene(*shapes), *many, threads=1)
    for threads in (2, 5):
        for part, same in zip(one, minirt.trace(scene(*shapes), *many, threads=threads), strict=True):
            assert np.array_equal(part, same, equal_nan=True)


def test_the_bvh_is_built_anew_for_an_edited_scene_and_kept_for_the_same_one(monkeypatch: pytest.MonkeyPatch) -> None:
    origins, directions = np.zeros((1, 3)), np.array([[0.0, 0, 1]])
    before = scene(BALL, FLOOR)
    minirt.trace(scene(COLUMN), origins, directions)
    built: list[Any] = []
    build = scene_packing.build_bvh
    monkeypatch.setattr(scene_packing, "build_bvh", lambda *given: built.append(1) or build(*given))
    for made, distance in ((before, 4), (before, 4), (before.replace(BALL, diameter=4), 3), (before, 4)):
        assert minirt.trace(made, origins, directions).distance.tolist() == [distance]
    assert len(built) == 3


def test_hits_have_certificates() -> None:
    hits = minirt.trace(scene(BALL, FLOOR), np.zeros((4, 3)), [[0, 0, 1], [0, -1, 1], [0, 1, 0], [0, -3, 0]])
    assert hits.owner.tolist() == [0, 1, -1, 1]
    # |o - c| + t + size: 5 + 4 + 2 for the ball; 1 + t for the floor, which has no size.
    expected = [11 / 4, (1 + 2**0.5) / (2**0.5 * 0.5**0.5), np.nan, 2]
    assert hits.condition == pytest.approx(expected, rel=1e-12, nan_ok=True)
    assert hits.backward_error[[0, 3]].tolist() == [0, 0]
    assert 0 <= hits.backward_error[1] <= 4
    assert np.isnan(hits.backward_error[2])
    assert hits.normal_error[[0, 1, 3]].tolist() == [0, 0, 0]
    assert hits.backward_error is hits.backward_error  # computed once


def test_certificates_are_computed_on_first_use_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    certify = certificates.certify
    monkeypatch.setattr(certificates, "certify", lambda *arguments: calls.append(1) or certify(*arguments))
    hits = minirt.trace(scene(BALL), np.zeros((1, 3)), [[0, 0, 1]])
    assert not calls
    for _ in range(2):
        assert (hits.backward_error, hits.condition, hits.normal_error) == (0, 2.75, 0)
    assert len(calls) == 1
    with pytest.raises(ValueError, match=r"^only hits that"):
        _ = hits._replace(distance=hits.distance).condition


@pytest.mark.parametrize("scale", [1e-49, 1e-12, 1.0, 1e12])
@pytest.mark.parametrize("length", [5e-324, 1e-200, 1.0, 1e308])
def test_certificates_know_no_scale(scale: float, length: float) -> None:
    ball, floor = Sphere((0, 0, 5 * scale), 2 * scale, RED), Plane((0, -scale, 0), (0, 1, 0), RED)
    origins = np.array([[0.3 * scale, 0, 0]] * 2)
    hits = minirt.trace(scene(ball, floor), origins, [[0, 0, length], [0, -length, length]])
    assert hits.owner.tolist() == [0, 1]
    assert hits.backward_error.max() <= 4
    assert hits.condition == pytest.approx([2.9, 2.5], abs=0.4)


def test_a_picture_imports_no_queries_and_an_import_no_compiler() -> None:
    program = """
import sys, minirt
scene = minirt.load("scenes/subject.rt")
minirt.render(scene, 8, 8)
print(*(name in sys.modules for name in ("numba", "minirt.rendering.queries.rays")))
"""
    done = run([sys.executable, "-c", program], text=True)
    assert done.stdout.split() == ["False"] * 2
    program = "import sys, minirt; minirt.trace; print('numba' in sys.modules, 'llvmlite' in sys.modules)"
    done = run([sys.executable, "-c", program], text=True)
    assert done.stdout.split() == ["False"] * 2
