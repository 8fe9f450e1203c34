"""Hits, points of surfaces, boxes and balls of every shape, against answers known by hand.

Rays that are hard for the formulas are in `tests.stability`.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from minirt.errors import ElementError
from minirt.shapes import Shape
from minirt.shapes.box import Box
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle
from tests import oracle
from tests.shapes.execution_modes import Intersect, U, shoot, surfaces
from tests.shapes.regimes import GREY

NEVER = np.inf
BALL = Sphere((0, 0, 5), 6, GREY)  # radius 3: its edge is seen from the origin along a 3-4-5 triangle
FLOOR = Plane((7, -2, 9), (0, 1, 0), GREY)
TUBE = Cylinder((0, 0, 5), (0, 1, 0), 6, 4, GREY)  # radius 3, from y = -2 to y = 2
TENT = Cone((0, 4, 5), (0, -1, 0), 6, 4, GREY)  # radius 3 at y = 0: its sides are the long ones of 3-4-5 triangles
BOWL = Paraboloid((0, -1, 5), (0, 1, 0), 4, 4, GREY)  # x^2 + (z - 5)^2 = y + 1, from y = -1 to y = 3
TOWER = Hyperboloid((0, 0, 5), (0, 1, 0), 6, 10, 8, GREY)  # x^2 + (z - 5)^2 = 9 + y^2, from y = -4 to y = 4
FLAT_TOWER = Hyperboloid((0, 0, 5), (0, 1, 0), 6, 10, 2, GREY)  # x^2 + (z - 5)^2 = 9 + 16 y^2, from y = -1 to y = 1
TUBE_TOWER = Hyperboloid((0, 0, 5), (0, 1, 0), 6, 6, 4, GREY)  # a waist as wide as the ends
EGG = Ellipsoid((0, 0, 5), (0, 1, 0), (4, 2, 6), GREY)  # semi-axes 2, 1 and 3 along x, y and z
TURNED_EGG = Ellipsoid((0, 0, 5), (1, 0, 0), (4, 2, 6), GREY)  # 1, 2 and 3: its y axis is the scene's x
SAIL = Triangle((-2, 0, 5), (2, 0, 5), (0, 3, 8), GREY)
BOARD = Square((0, 1, 5), (0.6, 0, -0.8), 4, GREY)  # 2 to each side, turned by a 3-4-5 triangle, and upright
PLATE = Disc((0, 1, 5), (0.6, 0, -0.8), 4, GREY)  # radius 2, turned likewise
BLOCK = Box((0, 1, 5), (0, 1, 0), (2, 4, 6), GREY)  # from -1, -1, 2 to 1, 3, 8
RING = Torus((0, 1, 5), (0, 1, 0), 6, 2, GREY)  # radii 3 and 1

Ray = tuple[tuple[float, ...], tuple[float, ...], float]  # origin, direction and t, infinity for a miss
SIDE = (4.9**2 - 9) ** 0.5  # height at which the side of the tower is 4.9 wide
AHEAD, DOWN, RIGHT = (0, 0, 1), (0, -1, 0), (1, 0, 0)
# `tests.stability` holds the formulas equal to the boundaries of shapes, and these hold what both of them mean.
SAIL_RAYS: list[Ray] = [
    ((0, 1, 0), AHEAD, 6),  # z = 5 + y
    ((0, 1, 0), (0, 0, -1), NEVER),  # behind
    ((0, 2, 9), (0, 0, -1), 2),  # from its back
    ((0, 9, 6), DOWN, 8),  # from above, at y = 1
    ((1.3, 1, 0), AHEAD, 6),  # 1 / 30 within the edge, at y = 1
    ((1.4, 1, 0), AHEAD, NEVER),  # and past it
    ((-1.3, 1, 0), AHEAD, 6),
    ((-1.4, 1, 0), AHEAD, NEVER),
    ((0, -0.01, 0), AHEAD, NEVER),
    ((0, 3.01, 0), AHEAD, NEVER),
    ((0, 1, 6), AHEAD, NEVER),  # from it
    ((0, 1, 2), (0, 0.6, 0.8), NEVER),  # y + 5 = z: 0.2 t = 4
]
HITS: list[tuple[Shape, list[Ray]]] = [
    *((Triangle(*corners, GREY), SAIL_RAYS) for corners in permutations((SAIL.a, SAIL.b, SAIL.c))),
    (BALL, [((0, 0, 0), AHEAD, 2), ((1.8, 0, 0), AHEAD, 2.6), ((3.1, 0, 0), AHEAD, NEVER)]),
    (FLOOR, [((0, 1, 0), (0.8, -0.6, 0), 5), ((0, -5, 0), (0, 1, 0), 3), ((0, 0, 0), (0, 1, 0), NEVER)]),
    (TUBE, [((0, 0, 0), AHEAD, 2), ((0, 5, 5), (0.6, -0.8, 0), 3.75), ((0, 0, 5), (0.8, 0.6, 0), 10 / 3)]),
    (TENT, [((0, 2, 0), AHEAD, 3.5), ((1.5, 9, 5), DOWN, 7), ((0, 1, 5), DOWN, 1), ((0, 6, 5), (0.6, -0.8, 0), NEVER)]),
    (BOWL, [((0, 0, 0), AHEAD, 4), ((1, -3, 5), (0, 1, 0), 3), ((1, 9, 5), DOWN, 6)]),
    (TOWER, [((0, 0, -5), AHEAD, 7), ((4.9, 3.95, 5), DOWN, 3.95 - SIDE), ((4, -3, 5), DOWN, 1)]),
    (TUBE_TOWER, [((1.8, 0, 0), AHEAD, 2.6), ((2.9, 9, 5), DOWN, 7), ((0, 0, 5), (0.8, 0.6, 0), 10 / 3)]),
    (EGG, [((0, 0, 0), AHEAD, 2), ((0, 0, 5), RIGHT, 2), ((1.2, 0, 0), AHEAD, 2.6)]),
    (TURNED_EGG, [((0, 0, 5), RIGHT, 1), ((0, 0, 5), (0, 1, 0), 2), ((0, 0, 5), AHEAD, 3)]),
    (BOARD, [((0, 1, 0), AHEAD, 5), ((1.59, 2.99, 0), AHEAD, 5 + 0.75 * 1.59), ((0, 3.01, 0), AHEAD, NEVER)]),
    (BOARD.replace(normal=(0, 1, 0)), [((1.99, 3, 6.99), DOWN, 2), ((2.01, 3, 5), DOWN, NEVER)]),  # its edges: x and z
    (PLATE, [((0, 1, 0), AHEAD, 5), ((0, 3, 0), AHEAD, 5), ((1.2, 2.4, 0), AHEAD, NEVER)]),  # a square would be hit
    (
        BLOCK,
        [((0, 0, 0), AHEAD, 2), ((-9, 1, 5), RIGHT, 8), ((0, 2.9, 9), (0, 0, -1), 1), ((0, 3.01, 0), AHEAD, NEVER)],
    ),
    (RING, [((0, 1, 0), AHEAD, 1), ((0, 9, 2), DOWN, 7), ((0, 9, 7.5), DOWN, 8 - 0.75**0.5), ((0, 9, 5), DOWN, NEVER)]),
    (RING.replace(tube=6), [((0, 9, 5.5), DOWN, 8 - (9 - 2.5**2) ** 0.5), ((0, 9, 8), DOWN, 5)]),  # without a hole
]


def title(value: object) -> str:
    return value.title if isinstance(value, Shape) else ""


@pytest.mark.parametrize(("shape", "rays"), HITS, ids=title)
def test_hits(intersect: Intersect, shape: Shape, rays: list[Ray]) -> None:
    expected = pytest.approx([t for *_, t in rays], rel=3e-15)
    assert shoot(intersect, shape, *((origin, direction) for origin, direction, _ in rays)) == expected


@pytest.mark.parametrize(("shape", "rays"), HITS, ids=title)
def test_the_oracle_has_the_same_answers(shape: Shape, rays: list[Ray]) -> None:
    found = [oracle.nearest(shape, origin, direction) for origin, direction, _ in rays]
    assert found == pytest.approx([t for *_, t in rays], rel=3e-15)


@pytest.mark.parametrize(("slope", "seen"), [(1e-6, True), (np.nextafter(4 * U, 1), True), (4 * U, False), (0, False)])
@pytest.mark.parametrize("shape", [FLOOR, PLATE, BOARD], ids=title)
def test_a_parallel_ray_misses(intersect: Intersect, shape: Shape, slope: float, seen: bool) -> None:
    lying = shape.replace(normal=(0, 1, 0))
    x, y, z = getattr(lying, "centre", None) or lying.point
    height = 1 if shape is FLOOR else slope
    seen = seen and height > 8 * U * 9  # lower than 8 roundings of its largest coordinate a ray starts on the plane
    (t,) = shoot(intersect, lying, ((x, y + height, z), (1, -slope, 0)))
    assert not seen or t == pytest.approx(height / slope, rel=1e-3 if slope > U * 8 else 1)
    assert seen or t == NEVER


def test_points_beside_the_special_places_of_a_surface() -> None:
    on, normal = surfaces([FLAT_TOWER], np.array([[[2.9, 0.2, 5]]]))  # inside the waist: onto it
    assert on[0, 0, 1] == 0
    assert np.abs(normal[0, 0] - [1, 0, 0]).max() <= 4 * U
    _, normal = surfaces([BOWL], np.array([[[0.6, -1.01, 5]]]))  # below the vertex
    assert np.abs(normal[0, 0] - [0, -1, 0]).max() <= 4 * U
    on, normal = surfaces([TENT], np.array([[[0, 4 - 2.0**-40, 5]]]))  # on the axis: to the apex
    assert (*on[0, 0], *normal[0, 0]) == (0, 4, 5, 0, 1, 0)
    on, normal = surfaces([RING], np.array([[[0, 1, 5.0]]]))  # on the axis, where every point of the ring is as near
    assert np.abs(np.linalg.norm(on[0, 0] - [0, 1, 5]) - 2) <= 8 * U * 5
    assert normal[0, 0, 1] == 0
    slopes = np.array([[1, 0, 0], [0, -1, 0], [0.3, 0.8, 0], [0, 0.6, -2.4 / 9]])
    normals = slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)
    for off in (1e-9, -1e-9):  # onto an ellipsoid along the normal
        right = np.array([[2, 0, 5], [0, -1, 5], [1.2, 0.8, 5], [0, 0.6, 5 - 2.4]])
        on, found = surfaces([EGG], (right + off * normals)[None])
        assert np.abs(on[0] - right).max() <= 8 * U * 5
        assert np.abs(found[0] - normals).max() <= 1e-8


TURNED = (0.6, 0, 0.8)
DISH = Paraboloid((0, 0, 0), (0.6, 0.8, 0), 4, 1, GREY)  # along y it bulges 3 / 4 as far from the axis as the rim
BOUNDS: list[tuple[Shape, tuple[float, ...], tuple[float, ...]]] = [
    (BALL, (-3, -3, 2), (3, 3, 8)),
    (Cylinder((1, 2, 3), TURNED, 10, 20, GREY), (-9, -3, -8), (11, 7, 14)),
    (Cone((1, 2, 3), TURNED, 10, 20, GREY), (1, -3, 3), (17, 7, 22)),
    (BOWL, (-2, -1, 3), (2, 3, 7)),
    (BOWL.replace(axis=(1, 0, 0)), (0, -3, 3), (4, 1, 7)),  # the box of the rim and the vertex
    (BOWL.replace(axis=(0.6, 0.8, 0)), (-4 / 15, -1.1125, 3), (4, 3.4, 7)),  # bulges beyond both
    (DISH, (-1, -0.45, -2), (2.2, 2, 2)),
    (DISH.replace(axis=(-0.6, -0.8, 0)), (-2.2, -2, -2), (1, 0.45, 2)),
    (Hyperboloid((1, 2, 3), TURNED, 4, 10, 20, GREY), (-9, -3, -8), (11, 7, 14)),
    (EGG, (-2, -1, 2), (2, 1, 8)),
    (TURNED_EGG, (-1, -2, 2), (1, 2, 8)),
    (SAIL, (-2, 0, 5), (2, 3, 8)),
    (BOARD, (-1.6, -1, 3.8), (1.6, 3, 6.2)),
    (PLATE, (-1.6, -1, 3.8), (1.6, 3, 6.2)),
    (BLOCK, (-1, -1, 2), (1, 3, 8)),
    (BLOCK.replace(axis=(0.6, 0.8, 0)), (-2, -1.2, 2), (2, 3.2, 8)),
    (RING, (-4, 0, 1), (4, 2, 9)),
    (RING.replace(centre=(7, 8, 9)), (3, 7, 5), (11, 9, 13)),
    (RING.replace(axis=(0.6, 0.8, 0)), (-3.4, -1.8, 1), (3.4, 3.8, 9)),
]


@pytest.mark.parametrize(("shape", "low", "high"), BOUNDS, ids=title)
def test_boxes(shape: Shape, low: tuple[float, ...], high: tuple[float, ...]) -> None:
    assert shape.bounds() == (pytest.approx(low), pytest.approx(high))


def test_the_box_of_a_wide_disc_that_is_hardly_tilted() -> None:
    # Its rim rises by radius times tilt, though 1 - cos^2 of the tilt is nothing in float64.
    _, (_, top, _) = Cylinder((0, 0, 0), (1e-9, 1, 0), 2e6, 1e-6, GREY).bounds()
    assert top == pytest.approx(1e6 * 1e-9 + 5e-7, rel=1e-12)


def test_balls() -> None:
    assert BALL.balls() == (((0, 0, 5), 3),)
    ends = Cylinder((1, 2, 3), TURNED, 10, 20, GREY).balls()
    assert ends == ((pytest.approx((7, 2, 11)), 5), (pytest.approx((-5, 2, -5)), 5))
    assert Hyperboloid((1, 2, 3), TURNED, 4, 10, 20, GREY).balls() == ends[::-1]
    assert Cone((1, 2, 3), TURNED, 10, 20, GREY).balls() == (((1, 2, 3), 0), (pytest.approx((13, 2, 19)), 5))
    assert BOWL.balls() == (((0, -1, 5), 1), ((0, 3, 5), 2))
    assert sorted(EGG.balls()) == [((x, 0, z), 1) for x in (-1, 1) for z in (3, 7)]
    assert SAIL.balls() == ((SAIL.a, 0), (SAIL.b, 0), (SAIL.c, 0))
    assert PLATE.balls() == (((0, 1, 5), 2),)
    assert sorted(BOARD.balls())[0] == (pytest.approx((-1.6, -1, 3.8)), 0)
    assert {radius for _, radius in (*BOARD.balls(), *BLOCK.balls())} == {0}
    assert (len(BOARD.balls()), len(BLOCK.balls()), len(RING.balls())) == (4, 8, 8)
    middles = np.array([centre for centre, _ in RING.balls()])
    assert np.allclose(np.linalg.norm(middles - RING.centre, axis=1), 3 / np.cos(np.pi / 8))
    assert np.allclose(middles[:, 1], 1)
    assert np.allclose(np.linalg.norm(middles - np.roll(middles, 1, axis=0), axis=1), 6 * np.tan(np.pi / 8))
    assert {radius for _, radius in RING.balls()} == {1}


@pytest.mark.parametrize(
    ("shape", "name", "least", "refused", "message"),
    [
        (TOWER, "diameter", 6, 5, "hyperboloid waist must be at most the diameter, 5, got 6"),
        (RING, "tube", 6, 7, "torus tube must be at most the diameter, 6, got 7"),
    ],
    ids=title,
)
def test_sizes_that_contradict_each_other_are_refused(
    shape: Shape, name: str, least: float, refused: float, message: str
) -> None:
    with pytest.raises(ElementError, match=message):
        shape.replace(**{name: refused})
    assert getattr(shape.replace(**{name: least}), name) == least
