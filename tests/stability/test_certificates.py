"""Certificates of hits, against the oracle; wrong hits must be noticed."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.fields import MeshFile
from minirt.lanes import Vec, dot, sqrt
from minirt.rendering.queries import certificates
from minirt.rendering.queries.certificates import Certificate
from minirt.scene import Scene
from minirt.shapes import KINDS, Cone, Cylinder, Kind, Mesh, Shape, Torus, Triangle
from minirt.shapes.boundary import Boundary
from tests.paths import SCENES
from tests.shapes.execution_modes import on_arrays
from tests.shapes.regimes import GREY, RAYS, Array, random_directions
from tests.stability import regime
from tests.stability.common import EYE, towards
from tests.stability.regime import BOUND, ExactCertificate, Regime, certified, rays_of, surfaces_at
from tests.stability.table import REGIMES

WITHIN = 0.02  # relative difference of a certificate and the exact one
LEAST = 1e-13  # backward error that double-double numbers do not resolve: 2^-104 of the coordinates
NEARLY = 1e-14  # error of the normal that float64 does not resolve
KIND = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)


@cache
def usual(kind: Kind) -> tuple[Any, Array, Array]:
    """Usual rays at shapes of a kind, their hits and the normals there."""
    rays = towards(kind, 31)
    t = on_arrays(*rays)
    return rays, t, surfaces_at(rays, t)[1]


def differs(found: Any, right: ExactCertificate) -> bool:
    """Whether a certificate is not the exact one."""
    backward, condition, normal = found
    return not (
        abs(backward - right.backward_error) <= WITHIN * right.backward_error + LEAST
        and (condition == right.condition or abs(condition - right.condition) <= WITHIN * right.condition)
        and abs(normal - right.normal_error) <= WITHIN * right.normal_error + NEARLY
    )


def wrong(rays: Any, t: Array, normals: Array, found: Certificate, indices: Any) -> int:
    """The number of hits, given by their indices (shape, ray), whose certificate differs from the exact one."""
    count = 0
    for i, j in indices:
        shape, origin, direction = rays.shapes[i], rays.origins[i, j], rays.directions[i, j]
        right = regime.certificate(shape, origin, direction, t[i, j], normals[i, j])
        assert right is not None
        count += differs([part[i, j] for part in found], right)
    return count


@pytest.mark.parametrize(
    ("kind", "regime"), REGIMES, ids=lambda each: each.element.title if isinstance(each, Kind) else each.name
)
def test_certificates_are_those_of_the_oracle_and_hits_hold_the_backward_bound(kind: Kind, regime: Regime) -> None:
    rays = rays_of(regime)
    t = on_arrays(*rays)
    normals = surfaces_at(rays, t)[1]
    found = certified(rays, t, normals)
    worst = np.unravel_index(np.nanargmax(found.backward_error), t.shape)
    middle = np.argwhere(np.isfinite(t))[np.isfinite(t).sum() // 2]
    assert wrong(rays, t, normals, found, [worst, middle]) == 0
    assert found.backward_error[worst] <= BOUND


def larger(boundary: Callable[..., Boundary]) -> Callable[..., Boundary]:
    """A boundary whose faces lie a few roundings of their size farther out: a slip in a declaration."""

    def moved(shape: Any, point: Vec) -> Boundary:
        right = boundary(shape, point)
        return Boundary(
            tuple(face - 2.0**-51 * sqrt(dot(face.slope, face.slope)) for face in right.faces), right.limits
        )

    return moved


@KIND
def test_a_wrong_boundary_is_noticed(kind: Kind, monkeypatch: pytest.MonkeyPatch) -> None:
    rays, t, normals = usual(kind)
    hits = np.argwhere(np.isfinite(t))[:8]
    assert wrong(rays, t, normals, certified(rays, t, normals), hits) == 0
    monkeypatch.setattr(certificates, "ALL_KINDS", [kind._replace(boundary=larger(kind.boundary))])
    assert wrong(rays, t, normals, certified(rays, t, normals), hits) >= 6


@KIND
def test_a_hit_off_by_100_units_in_the_last_place_is_noticed(kind: Kind) -> None:
    rays, t, normals = usual(kind)
    condition = certified(rays, t, normals).condition
    steep = condition < 200 / (2 * BOUND)  # 100 units in the last place of t are up to 200 roundings
    assert steep.sum() > 30
    assert (certified(rays, t, normals).backward_error[steep] <= BOUND).all()
    for ulps in (-100, 100):
        moved = t + ulps * np.spacing(t)
        assert (certified(rays, moved, normals).backward_error[steep] > BOUND).mean() > 0.6
        far = t + 2 * ulps * np.spacing(t)
        assert (certified(rays, far, normals).backward_error[steep] > BOUND).all()


@KIND
def test_a_wrong_normal_is_noticed(kind: Kind) -> None:
    rays, t, normals = usual(kind)
    hit = np.isfinite(t)
    assert certified(rays, t, normals).normal_error[hit].max() < 1e-12
    opposite = certified(rays, t, -normals)
    assert ((opposite.normal_error > 1) | (opposite.backward_error > BOUND))[hit].all()  # that of another face
    turned = normals + 1e-9 * random_directions(np.random.default_rng(1), len(t), RAYS)
    assert np.median(certified(rays, t, turned).normal_error[hit]) > 5e-10


def test_the_nearest_face_counts_and_at_a_rim_the_normal_of_either() -> None:
    """The point may not lie beyond the end of the face."""
    tube, tent = Cylinder((0, 0, 0), (0, 1, 0), 2, 2, GREY), Cone((0, 1, 0), (0, -1, 0), 1, 2, GREY)
    down, side, cap = [[0.0, -1, 0]], [[1.0, 0, 0]], [[0.0, 1, 0]]

    def errors(x: float, t: float, normal: Any, shape: Shape = tube) -> tuple[float, float]:
        rays = certificates.Rays(*map(np.array, ([[x, 5.0, 0]], down, [t], normal)))
        found = certificates.certify((shape,), np.array([0]), np.array([0]), rays)
        return float(found.backward_error[0]), float(found.normal_error[0])

    def error(x: float, t: float, normal: Any, shape: Shape = tube) -> float:
        return errors(x, t, normal, shape)[0]

    assert error(0.5, 4.0, cap) == 0
    assert errors(0.5, 4.0, side) == (0, 2**0.5)  # half a unit from the side
    assert errors(1.0 - 2.0**-52, 4.0, side) == errors(1.0 - 2.0**-52, 4.0, cap) == (0, 0)
    assert error(1.0, 4.5, side) == 0
    assert error(1.0, 3.5, side) > 1e14  # on the side, extended beyond the cap
    assert error(1.0 + 2.0**-52, 4.0, cap) == pytest.approx(2 / (4 + np.hypot(5, 1) + 4))
    assert error(2.0, 4.0, cap) > 1e14
    assert error(0.5, 4.0, [[np.nan] * 3]) == 0  # the nearest
    steep = np.array([[4.0, 1, 0]]) / np.sqrt(17)
    assert error(2.0**-60, 4.0, steep, tent) < 1
    assert error(-(2.0**-60), 4.0, steep, tent) < 1  # at the apex the normal may be that of the other side


def test_certificates_of_a_torus_without_a_hole_are_exact_on_its_axis() -> None:
    """There the surface closes to a cusp: 1e-8 up, it is 1e-16 away."""
    horn, down = Torus((0, 0, 0), (0, 1, 0), 1, 1, GREY), [[0.0, -1, 0]]
    for up in (2.0**-27, 2.0**-20, 0.25):
        rays = certificates.Rays(*map(np.array, ([[0.0, 5, 0]], down, [5 - up], [[0.0, 1, 0]])))
        found = certificates.certify((horn,), np.array([0]), np.array([0]), rays)
        away = np.hypot(0.5, up) - 0.5 if up > 0.1 else up * up
        assert found.backward_error[0] == pytest.approx(away / (regime.U * (5 - up + 5 + 2)), rel=1e-9)


@pytest.mark.parametrize("name", ["icosahedron", "knot"])
def test_traced_triangles_of_meshes_are_certified_by_their_placed_corners(name: str) -> None:
    mesh = Mesh(MeshFile(str(SCENES / f"meshes/{name}.obj")), (3.0, -2.0, 7.0), 1.7, GREY)
    random = np.random.default_rng(3)
    directions = random_directions(random, 40)
    origins = np.array(mesh.position) + 1.7 * random.uniform(-1, 1, (40, 3)) - 9 * directions
    hits = minirt.trace(Scene((EYE, mesh)), origins, directions)
    corners = mesh.rows()[:, :9].reshape(-1, 3, 3)
    checked = 0
    for i in np.flatnonzero(hits.owner == 0)[:12]:
        off = np.abs(np.einsum("nk,nk->n", mesh.rows()[:, 9:12], corners[:, 0] - hits.point[i]))
        inside = np.abs(corners.mean(axis=1) - hits.point[i]).max(axis=1) < np.ptp(corners, axis=1).max(axis=1)
        a, b, c = corners[np.argmin(np.where(inside, off, np.inf))]
        if np.dot(np.cross(b - a, c - a), hits.normal[i]) < 0:
            b, c = c, b
        triangle = Triangle(tuple(a), tuple(b), tuple(c), GREY)
        right = regime.certificate(triangle, origins[i], directions[i], hits.distance[i], hits.normal[i])
        assert right is not None
        found = hits.backward_error[i], hits.condition[i], hits.normal_error[i]
        checked += not differs(found, right)
    assert checked >= 11  # at an edge the nearest triangle may be the neighbour
    assert np.nanmax(hits.backward_error) <= BOUND
