"""Certificates of hits, against distances in closed form and 60 digits; wrong hits must be noticed."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise, product
from typing import Any

import numpy as np
import pytest
from gmpy2 import mpfr, sqrt

import minirt
from minirt.element import fields_of
from minirt.fields import Length, MeshFile
from minirt.lanes import Vec, dot
from minirt.lanes import sqrt as root
from minirt.rendering.queries import certificates
from minirt.scene import Camera, Scene
from minirt.shapes import KINDS, Box, Cone, Cylinder, Disc, Kind, Mesh, Plane, Shape, Sphere, Torus, Triangle
from minirt.shapes.boundary import Boundary
from tests import oracle
from tests.paths import SCENES
from tests.seeds import RUN
from tests.shapes.examples import example
from tests.shapes.execution_modes import on_arrays
from tests.shapes.regimes import GREY, Array, Random, random_directions
from tests.stability.rays import Pose, hull, pose, rays
from tests.stability.verdicts import BOUND, U, certified, off

EYE = Camera((0, 0, 0), (0, 0, 1), 60)
CHECKED = 200  # points whose distances are compared
SHAPES = 100  # at most: of each, 64 rays give at least a few such points
LEAST = 1e-13  # backward error that double-double numbers do not resolve: 2^-104 of the coordinates
KIND = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)


def usual(kind: Kind, seed: int = 31) -> tuple[Shape, Array, Array, Array]:
    """A usual shape, rays at it that hit, and t."""
    random = np.random.default_rng(seed)
    shape = example(kind, random)
    targets = hull(shape, random, 256)
    directions = random_directions(random, 256)
    origins = targets - 9 * directions
    t = on_arrays([shape], origins[None], directions[None])[0]
    hit = np.isfinite(t)
    return shape, origins[hit], directions[hit], t[hit]


Point = list[Any]  # mpfr numbers


def minus(a: Any, b: Any) -> Point:
    return [
        mpfr(float(x)) - mpfr(float(y)) if not isinstance(x, mpfr) else x - mpfr(float(y))
        for x, y in zip(a, b, strict=True)
    ]


def inner(a: Any, b: Any) -> Any:
    return sum((mpfr(x) * mpfr(y) for x, y in zip(a, b, strict=True)), mpfr(0))


def length(a: Any) -> Any:
    return sqrt(inner(a, a))


def to_segment(p: Point, a: Point, b: Point) -> Any:
    """Distance of a point from a segment, in any number of dimensions."""
    along = [y - x for x, y in zip(a, b, strict=True)]
    way = [x - y for x, y in zip(p, a, strict=True)]
    share = min(max(inner(way, along) / inner(along, along), mpfr(0)), mpfr(1))
    return length([x - share * y for x, y in zip(way, along, strict=True)])


def distance(shape: Any, origin: Any, direction: Any, t: float) -> float:
    """The distance of the point at t of a ray from the surface of a shape, in closed form."""
    d = [mpfr(float(x)) for x in direction]
    o = minus(origin, oracle.points(shape)[0])
    p = [x + mpfr(float(t)) * y / length(d) for x, y in zip(o, d, strict=True)]
    if isinstance(shape, Sphere):
        return float(abs(length(p) - mpfr(shape.diameter) / 2))
    if isinstance(shape, Triangle):
        return float(to_triangle(p, [mpfr(0)] * 3, minus(shape.b, shape.a), minus(shape.c, shape.a)))
    axis = [mpfr(float(x)) for x in (shape.normal if hasattr(shape, "normal") else shape.axis)]
    axis = [x / length(axis) for x in axis]
    height = inner(p, axis)
    rho = length([x - height * y for x, y in zip(p, axis, strict=True)])
    if isinstance(shape, Plane):
        return float(abs(height))
    radius = mpfr(shape.diameter) / 2
    if isinstance(shape, Disc):
        return float(length([height, max(rho - radius, mpfr(0))]))
    if isinstance(shape, Torus):
        return float(abs(length([rho - radius, height]) - mpfr(shape.tube) / 2))
    tall, nothing = mpfr(shape.height), mpfr(0)
    if isinstance(shape, Cylinder):
        corners = [[nothing, -tall / 2], [radius, -tall / 2], [radius, tall / 2], [nothing, tall / 2]]
    else:
        assert isinstance(shape, Cone)
        corners = [[nothing, nothing], [radius, tall], [nothing, tall]]
    return float(min(to_segment([rho, height], *ends) for ends in pairwise(corners)))


def to_triangle(p: Point, a: Point, b: Point, c: Point) -> Any:
    """Distance of a point from a triangle: from its plane above it, elsewhere from the nearest edge."""
    (x, y, z), (u, v, w) = ([s - r for r, s in zip(a, end, strict=True)] for end in (b, c))
    normal = [y * w - z * v, z * u - x * w, x * v - y * u]
    height = inner([r - s for r, s in zip(p, a, strict=True)], normal) / length(normal)
    foot = [r - height * s / length(normal) for r, s in zip(p, normal, strict=True)]
    edges = [(a, b), (b, c), (c, a)]

    def inward(start: Point, end: Point) -> Any:
        (x, y, z), (u, v, w) = ([s - r for r, s in zip(start, to, strict=True)] for to in (end, foot))
        return inner([y * w - z * v, z * u - x * w, x * v - y * u], normal)

    inside = all(inward(*edge) >= 0 for edge in edges)
    return abs(height) if inside else min(to_segment(p, *edge) for edge in edges)


CLOSED = [kind for kind in KINDS if kind.element in (Sphere, Plane, Triangle, Disc, Torus, Cylinder, Cone)]


def least(shape: Shape) -> float:
    """The least length of a shape."""
    return min([getattr(shape, e.name) for e in fields_of(type(shape)) if isinstance(e, Length)], default=1.0)


def moved(random: Random, shape: Shape, origins: Array, directions: Array, t: Array) -> Array:
    """Wrong answers: some roundings off, and at a tenth of the rays far off; so are points beside edges and corners."""
    return t * (1 + U * random.normal(size=len(t)) * random.choice([1.0, 30.0, 1e9], len(t)))


@pytest.mark.parametrize("kind", CLOSED, ids=lambda kind: kind.element.title)
def test_certificates_are_distances_at_faces_edges_and_corners(kind: Kind) -> None:
    random, checked = np.random.default_rng(RUN), 0
    for _ in range(SHAPES):
        if checked >= CHECKED:
            break
        shape = pose(kind, random, Pose((1e-3, 1e3), (1.0, 1e6), (1e-6, 1.0)))
        with np.errstate(all="ignore"):
            origins, directions = rays(shape, random, 64)
        t = np.linalg.norm(oracle.points(shape)[0] - origins, axis=1) * random.uniform(0.9, 1.1, 64)
        found = on_arrays([shape], origins[None], directions[None])[0]
        t = moved(random, shape, origins, directions, np.where(np.isfinite(found), found, t))
        scale = U * (t + np.linalg.norm(origins - oracle.points(shape)[0], axis=1) + oracle.size(shape))
        errors = certified(shape, origins, directions, t).backward_error
        for i in range(64):
            right = distance(shape, origins[i], directions[i], t[i])
            tip = np.linalg.norm(origins[i] + t[i] * directions[i] - oracle.points(shape)[0])
            if isinstance(shape, Cone) and tip < 1e3 * right:
                continue  # beside the apex the side is curved as strongly as the point is far from it
            if 0 < right < 1e-3 * least(shape):  # from far off the nearest point may be on another side
                checked += 1
                given = RUN, shape, origins[i].tolist(), directions[i].tolist(), t[i]
                assert abs(errors[i] * scale[i] - right) <= 0.02 * right + LEAST * scale[i], given
    assert checked >= CHECKED


def test_a_point_beyond_a_corner_of_a_box_is_as_far_as_its_corner() -> None:
    box = Box((0, 0, 0), (0, 1, 0), (2, 4, 6), GREY)
    for signs in product((0, 1, -1), repeat=3):
        beyond = 2.0**-40 * np.array(signs) * [1, 2, 2]
        point = np.where(signs, np.sign(signs) * [1, 2, 3], [0.5, 0.5, 3]) + beyond
        direction = np.array([[0.0, 0, -1]])
        error = certified(box, point[None] - 2 * direction, direction, np.array([2.0])).backward_error[0]
        scale = U * (2 + np.linalg.norm(point - 2 * direction[0]) + 12)
        assert error * scale == pytest.approx(np.linalg.norm(beyond), rel=1e-6, abs=1e-25), signs


def larger(boundary: Callable[..., Boundary]) -> Callable[..., Boundary]:
    """A boundary whose faces lie a few roundings of their size farther out: a slip in a declaration."""

    def moved(shape: Any, point: Vec) -> Boundary:
        right = boundary(shape, point)
        return Boundary(
            tuple(face - 2.0**-49 * root(dot(face.slope, face.slope)) for face in right.faces), right.limits
        )

    return moved


@KIND
def test_a_wrong_boundary_is_noticed(kind: Kind, monkeypatch: pytest.MonkeyPatch) -> None:
    given = usual(kind)
    assert certified(*given).backward_error.max() <= BOUND
    assert off(*given).max() <= BOUND
    monkeypatch.setattr(certificates, "ALL_KINDS", [kind._replace(boundary=larger(kind.boundary))])
    assert (np.abs(certified(*given).backward_error - off(*given)) > 0.1).mean() > 0.7


@KIND
def test_a_hit_off_by_100_units_in_the_last_place_is_noticed(kind: Kind) -> None:
    shape, origins, directions, t = usual(kind)
    condition = certified(shape, origins, directions, t).condition
    steep = condition < 200 / (2 * BOUND)  # 100 units in the last place of t are up to 200 roundings
    assert steep.sum() > 10
    for ulps in (-200, 200):
        far = certified(shape, origins, directions, t + ulps * np.spacing(t))
        assert (far.backward_error[steep] > BOUND).all()


@KIND
def test_the_condition_is_the_change_of_t_by_a_change_of_the_data(kind: Kind) -> None:
    shape, origins, directions, t = usual(kind)
    found, normals = certified(shape, origins, directions, t), oracle.normals(shape, origins + t[:, None] * directions)
    scale = t + np.linalg.norm(origins - oracle.points(shape)[0], axis=1) + oracle.size(shape)
    slope = np.abs((normals * directions).sum(axis=1))
    assert (np.abs(found.condition - scale / (t * slope)) <= 1e-6 * found.condition).mean() > 0.98
    assert np.median(found.normal_error) < 1e-14
    assert found.normal_error.max() < 1e-8  # beside an apex


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
        assert found.backward_error[0] == pytest.approx(away / (U * (5 - up + 5 + 2)), rel=1e-9)


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
        exact = distance(triangle, origins[i], directions[i], hits.distance[i])
        scale = U * (hits.distance[i] + np.linalg.norm(origins[i] - a) + oracle.size(triangle))
        checked += abs(hits.backward_error[i] - exact / scale) <= 0.01 * exact / scale + LEAST
    assert checked >= 11  # at an edge the nearest triangle may be the neighbour
    assert np.nanmax(hits.backward_error) <= BOUND
