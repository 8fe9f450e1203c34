"""Hard shapes and rays of any kind: place x distance x units in the last place.

Nothing here knows a kind of shape. Its places are the points, axes and planes that its fields give, and where one, two
or three of the faces of its `boundary` meet: surface, edges and rims, corners and apexes. Ways through them are those
to another place, along axes, normals and edges, in tangent planes, and along the straight lines in a curved surface,
where its curvature vanishes: generators, rulings, asymptotes.
"""

from __future__ import annotations

from contextlib import suppress
from itertools import permutations, product
from typing import Any, NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.errors import ElementError
from minirt.fields import FARTHEST, Direction, Field, Length, Lengths, Point
from minirt.lanes import Vec
from minirt.shapes import Kind, Shape, Torus
from minirt.shapes.boundary import DoubleDouble
from minirt.shapes.frames import basis
from tests import oracle
from tests.shapes.examples import place, random_value
from tests.shapes.regimes import Array, Random, log_uniform, random_directions, unit

U = 2.0**-53
ALIGNED = [tuple(sign * axis) for axis in np.eye(3) for sign in (1.0, -1.0)]
TURNED = sorted(  # by 3-4-5 triangles
    {turned for i, j in product((3.0, -3.0), (4.0, -4.0)) for turned in permutations((i / 5, j / 5, 0.0))}
)
LENGTHS = (0.5, 1.0, 1.25, 2.0, 2.5, 3.0, 4.0, 5.0)
MOST = 1e14  # greatest coordinate


class Pose(NamedTuple):
    """Ranges from which shapes are drawn."""

    sizes: tuple[float, float] = (1e-12, 1e12)
    offsets: tuple[float, float] = (1.0, 1e12)  # from the origin of the scene, in sizes; half of the shapes are near it
    stretches: tuple[float, float] = (1e-9, 1e9)  # of one length of a quarter of the shapes


ANY, USUAL = Pose(), Pose((1.0, 1.0), (1.0, 1.0), (1.0, 1.0))


def pose(kind: Kind, random: Random, drawn: Pose = ANY) -> Shape:
    """A shape of a kind: its lengths, direction and place round numbers or general ones, one length stretched."""
    size = float(log_uniform(random, *drawn.sizes))
    away = size * float(log_uniform(random, *drawn.offsets)) * random.integers(2)
    middle = min(away, MOST) * random_directions(random)
    is_round = random.random() < 0.5
    if is_round:
        size = 2.0 ** np.rint(np.log2(size))
        middle = size * np.rint(middle / size)
    placed = [each for each in fields_of(kind.element) if not each.keyed]
    lengths = [each.name for each in placed if isinstance(each, Length)]
    while True:
        with suppress(ElementError):  # fields that contradict each other
            value_of = round_value if is_round else random_value
            values: Any = {each.name: value_of(each, random, size, middle) for each in placed}
            if lengths and random.random() < 0.25:
                name = random.choice(lengths)
                values[name] = float(np.clip(values[name] * log_uniform(random, *drawn.stretches), 1e-40, FARTHEST / 4))
            shape: Any = kind.element(**values)
            if hasattr(shape, "roll") and not kind.element.revolved and random.random() < 0.5:  # type: ignore[attr-defined]
                shape = shape.replace(roll=random.uniform(-360, 360))
            if not (isinstance(shape, Torus) and shape.tube == shape.diameter):  # a thicker one has a cavity
                return shape  # type: ignore[no-any-return]


def round_value(field: Field, random: Random, scale: float, middle: Array) -> object:
    """A value of a field with few digits."""
    if isinstance(field, Point):
        return tuple(middle + scale * random.integers(-3, 4, 3))
    if isinstance(field, Direction):
        ways = ALIGNED if random.random() < 0.5 else TURNED
        return ways[random.integers(len(ways))]
    if isinstance(field, Length):
        return scale * random.choice(LENGTHS)
    if isinstance(field, Lengths):
        return tuple(scale * random.choice(LENGTHS, 3))
    return random_value(field, random, scale, middle)


def hull(shape: Shape, random: Random, n: int) -> Array:
    """Random points in and around the hull of a shape's balls, (n, 3); near the point of an infinite one."""
    balls = shape.balls() or ((tuple(place(shape)), 1.0),)
    shares = random.dirichlet(np.full(len(balls), 0.5), n)
    radii = (shares @ np.array([radius for _, radius in balls]))[:, None]
    around = radii * 1.2 * random.random((n, 1)) * random_directions(random, n)
    return np.asarray(shares @ np.array([centre for centre, _ in balls]) + around)


def meeting(shape: Shape, near: Array, faces: Array) -> Array:
    """Find where the chosen faces and limits meet, (n, 3): Newton's method with least steps from points near there.

    `faces` (k, n) are their numbers.
    """
    first = oracle.points(shape)[0]
    centred = shape.replace(
        **{
            each.name: tuple(np.array(getattr(shape, each.name)) - first)
            for each in fields_of(type(shape))
            if isinstance(each, Point)
        }
    )
    at = near - first
    for _ in range(5):
        found = oracle.heights(centred, Vec(*map(DoubleDouble, at.T)))
        above = np.take_along_axis(np.concatenate([found.faces, found.limits]), faces, axis=0).T[..., None]
        slopes = np.take_along_axis(found.normals, faces[:, None], axis=0).transpose(2, 0, 1)
        with np.errstate(all="ignore"):
            step = np.nan_to_num(np.linalg.pinv(np.nan_to_num(slopes), rcond=1e-12) @ above)[..., 0]
        at = (
            at - np.clip(step, -1e3 * oracle.size(shape), 1e3 * oracle.size(shape)) if oracle.size(shape) else at - step
        )
    return first + at


def axes_of(shape: Shape) -> list[Array]:
    """The frames about the axes and normals of a shape, or the scene's axes."""
    given = [
        getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Direction) and not each.keyed
    ]
    frames = [np.array([[v.x, v.y, v.z] for v in basis(tuple(map(float, axis)))]) for axis in given]
    return list(np.concatenate(frames or [np.eye(3)]))


def places(shape: Shape, random: Random, n: int) -> Array:
    """Special places of a shape and some that are not, (n, 3)."""
    around, axes, centres = oracle.size(shape) or 1.0, np.array(axes_of(shape)), np.array(oracle.points(shape))
    centre = centres[random.integers(len(centres), size=n)]
    steps = around * random.choice([0.0, 0.25, 0.5, 1.0, 2.0, 0.37], (n, 2)) * random.choice([-1.0, 1.0], (n, 2))
    one, other = axes[random.integers(len(axes), size=(2, n))]
    on_line, on_plane = centre + steps[:, :1] * one, centre + steps[:, :1] * one + steps[:, 1:] * other
    near = hull(shape, random, n)
    near = np.where(random.random((n, 1)) < 0.3, centre + (near - centre) @ np.diag(random.integers(0, 2, 3)), near)
    heights = oracle.heights(shape, Vec(*map(DoubleDouble, near[:1].T)))
    count = len(heights.faces) + len(heights.limits)
    order = np.argsort(random.random((max(count, 3), n)), axis=0)[:3] % count
    found = np.stack([centre, on_line, on_plane, near, *6 * [near]])
    option = random.integers(len(found), size=n)
    chosen, meet = found[option, np.arange(n)], option >= 4
    # Of those, most lie on one face, and the last two options where two and three meet; a face counts once.
    faces = order[np.minimum(np.arange(3)[:, None], np.maximum(option - 7, 0)), np.arange(n)]
    chosen[meet] = meeting(shape, near[meet], faces[:, meet])
    return np.where(np.isfinite(chosen) & (np.abs(chosen - centre) < 1e6 * around), chosen, centre)


def straight(shape: Shape, at: Array, normal: Array, random: Random) -> Array:
    """Directions in the tangent plane along which a surface does not bend, or bends least."""
    u = unit(np.cross(normal, random_directions(random, len(at))))
    v = np.cross(normal, u)
    step = 1e-4 * min(
        (np.min(getattr(shape, e.name)) for e in fields_of(type(shape)) if isinstance(e, Length)), default=1.0
    )
    over_u, over_v = ((oracle.normals(shape, at + step * w) - oracle.normals(shape, at - step * w)) for w in (u, v))
    a, b, c = ((x * w).sum(axis=1) for x, w in ((over_u, u), (over_u, v), (over_v, v)))
    root = np.sqrt(np.maximum(b * b - a * c, 0.0)) * random.choice([-1.0, 1.0], len(at))
    swap = np.abs(a) > np.abs(c)
    one, other = np.where(swap, -b + root, c), np.where(swap, a, -b + root)
    return np.where((one == 0) & (other == 0), 1.0, one)[:, None] * u + other[:, None] * v


def ways(shape: Shape, at: Array, random: Random) -> Array:
    """Unit directions through places, (n, 3): special ones and any."""
    n, axes = len(at), np.array(axes_of(shape))
    with np.errstate(all="ignore"):
        found = oracle.heights(shape, Vec(*map(DoubleDouble, at.T)))
        nearest = np.argsort(np.abs(np.concatenate([found.faces, found.limits])), axis=0)
        normal, other = (
            np.take_along_axis(found.normals, nearest[i % len(nearest)][None, None], axis=0)[0].T for i in (0, 1)
        )
        tangent = np.cross(normal, random_directions(random, n))
        aligned = np.cross(normal, np.eye(3)[random.integers(3, size=n)])
        elsewhere = places(shape, random, n) - at
        options = [
            elsewhere,
            elsewhere,
            axes[random.integers(len(axes), size=n)],
            normal,
            tangent,
            tangent + log_uniform(random, 1e-17, 1e-1, n, 1) * normal * np.linalg.norm(tangent, axis=1)[:, None],
            aligned,
            straight(shape, at, normal, random),
            np.cross(normal, other),
            random_directions(random, n),
        ]
        way = np.stack(options)[random.integers(len(options), size=n), np.arange(n)]
        way = unit(way) * random.choice([-1.0, 1.0], (n, 1))
    return np.where(np.isfinite(way).all(axis=1, keepdims=True), way, random_directions(random, n))


def rays(shape: Shape, random: Random, n: int) -> tuple[Array, Array]:
    """Origins and unit directions of n rays, (n, 3) each: through places or beside, from there or from afar."""
    around, at = oracle.size(shape) or 1.0, places(shape, random, n)
    way = tilted(random, ways(shape, at, random))
    off = around * log_uniform(random, 1e-17, 1e-3, n, 1) * random_directions(random, n)
    at = np.where(random.random((n, 1)) < 0.3, at + off, at)
    far = around * np.stack(
        [
            np.zeros((n, 1)),
            2.0 ** random.integers(-3, 7, (n, 1)),
            9 * random.random((n, 1)),
            log_uniform(random, 1e-9, 1e6, n, 1),
        ]
    )
    origin = at - far[random.integers(len(far), size=n), np.arange(n)] * way
    return nudged(random, origin, around), way


def nudged(random: Random, points: Array, around: float) -> Array:
    """Half of the points by up to four units in the last place off, in some coordinates."""
    ulp = np.where(points == 0, U * around, np.spacing(np.abs(points)))
    return points + ulp * some_units(random, points)


TINY = (0.0, 5e-324, 1e-310, 1e-300, 1e-20)  # components of directions that take the place of a 0


def tilted(random: Random, directions: Array) -> Array:
    """Half of the directions by up to four units in the last place off, in some components; zeros of both signs."""
    tiny = np.where(random.random(directions.shape) < 0.5, U, random.choice(TINY, directions.shape))
    ulp = np.where(directions == 0, tiny, np.spacing(np.abs(directions)))
    tilt = directions + ulp * some_units(random, directions)
    return np.where(tilt == 0, random.choice([-1.0, 1.0], tilt.shape) * 0.0, unit(tilt))


def some_units(random: Random, points: Array) -> Array:
    units = random.integers(-4, 5, points.shape) * (random.random(points.shape) < 0.6)
    return np.where(random.random((len(points), 1)) < 0.5, units, 0)


def sent_on(shape: Shape, points: Array, normals: Array, random: Random) -> Array:
    """Directions from points that were hit: half of them nearly tangents, some at other places, some along an axis."""
    n = len(points)
    tangent = unit(np.cross(normals, random_directions(random, n)))
    rise = log_uniform(random, 1e-17, 1.0, n, 1) * random.choice([-1.0, 1.0], (n, 1))
    return np.where(random.random((n, 1)) < 0.5, unit(tangent + rise * normals), ways(shape, points, random))
