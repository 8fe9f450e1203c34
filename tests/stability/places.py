"""Special places of shapes: the points, lines, planes and circles at which their formulas degenerate.

Files in this folder declare those of each kind by `special`. Those that follow from the shape's declared fields and
from its surface are added here, and rays are put exactly on them.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import singledispatch
from importlib import import_module
from importlib.util import find_spec
from itertools import permutations, product
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.errors import ElementError
from minirt.fields import FARTHEST, Direction, Field, Length, Lengths, Point
from minirt.shapes import Kind, Shape, Torus
from minirt.shapes.frames import basis
from tests.shapes.examples import random_value
from tests.shapes.execution_modes import kind_of, surfaces
from tests.shapes.regimes import Array, Random, random_directions, unit
from tests.stability.regime import U, points, size

STEPS = (0.0, 0.25, 0.5, 0.75, 1.0, 2.0, 4.0)  # in sizes of the shape
TURNS = np.array([(1.0, 0.0), (0.0, 1.0), (0.6, 0.8), (0.8, 0.6)])  # cosine and sine


class Place(NamedTuple):
    """A set of points, which may reach beyond the shape, and for points of it directions that lie in it."""

    name: str
    points: Callable[[Random, int], Array]  # n of them, (n, 3)
    ways: Callable[[Random, Array], Array]  # (n, 3), of any length


def places(shape: Shape) -> list[Place]:
    """All special places of a shape; TypeError where its kind declares none."""
    files(kind_of(shape))  # which register them
    return [*of_fields(shape), *special(shape), surface(shape)]


@singledispatch
def special(shape: Shape) -> list[Place]:
    """The special places that the kind of a shape declares."""
    path = own_file(kind_of(shape)).replace(".", "/")
    raise TypeError(
        f"no special places of a {shape.title}: declare them in {path}.py, as tests/stability/solids.py does"
    )


def own_file(kind: Kind) -> str:
    """The module of this folder that is named as the shape's own."""
    return f"{__package__}.{kind.element.__module__.rpartition('.')[2]}"


def files(kind: Kind) -> list[ModuleType]:
    """The modules of this folder that declare regimes and special places, that of a new kind of shape among them."""
    names = (*(f"{__package__}.{name}" for name in ("revolved", "solids", "sheets")), own_file(kind))
    return [import_module(name) for name in names if find_spec(name)]


def of_fields(shape: Shape) -> list[Place]:
    """Of each point of a shape itself; with each of its axes the axis and the planes of its frame through the first."""
    first, *_ = centres = points(shape)
    axes = [getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Direction)]
    frames = [frame(axis) for axis in axes] or [tuple(np.eye(3))]
    found = [spot("point", point) for point in centres]
    found += [line("axis", shape, first, axis) for own in frames for axis in own]
    return found + [flat("plane of the frame", shape, first, normal) for own in frames for normal in own]


def frame(axis: Any) -> tuple[Array, Array, Array]:
    """The own frame of a shape about an axis or a normal, which is the last of three vectors."""
    u, v, w = (np.array([each.x, each.y, each.z], float) for each in basis(tuple(map(float, axis))))
    return u, v, w


def spot(name: str, point: Any) -> Place:
    """A point; its directions are those of the scene's axes and diagonals."""
    return Place(
        name,
        lambda random, n: np.tile(np.asarray(point, float), (n, 1)),
        lambda random, at: random.integers(-1, 2, at.shape) + np.where(random.random((len(at), 1)) < 0.5, 0.0, 1e-9),
    )


def line(name: str, shape: Shape, point: Any, direction: Any) -> Place:
    """A straight line through a point."""
    start, way = np.asarray(point, float), np.asarray(direction, float)
    return Place(
        name,
        lambda random, n: start + steps(random, shape, n) * way,
        lambda random, at: random.choice([-1.0, 1.0], (len(at), 1)) * way,
    )


def flat(name: str, shape: Shape, point: Any, normal: Any) -> Place:
    """A plane through a point."""
    start, (u, v, _) = np.asarray(point, float), frame(normal)

    def ways(random: Random, at: Array) -> Array:
        cosine, sine = turns(random, len(at))
        return cosine * u + sine * v

    return Place(name, lambda random, n: start + steps(random, shape, n) * u + steps(random, shape, n) * v, ways)


def ring(name: str, centre: Any, axis: Any, radius: float) -> Place:
    """A circle around an axis; the directions touch it."""
    middle, (u, v, w) = np.asarray(centre, float), frame(axis)

    def on(random: Random, n: int) -> Array:
        cosine, sine = turns(random, n)
        return middle + (radius * cosine) * u + (radius * sine) * v

    return Place(name, on, lambda random, at: random.choice([-1.0, 1.0], (len(at), 1)) * np.cross(w, at - middle))


def fan(name: str, shape: Shape, apex: Any, axis: Any, slope: float) -> Place:
    """The straight lines through a point at this slope (across by along) to an axis: the generators of a cone."""
    start, (u, v, w) = np.asarray(apex, float), frame(axis)

    def ways(random: Random, at: Array) -> Array:
        cosine, sine = turns(random, len(at))
        along: Array = random.choice([-1.0, 1.0], (len(at), 1)) * (w + slope * (cosine * u + sine * v))
        own = at - start
        return np.where(own.any(axis=-1, keepdims=True) & (random.random((len(at), 1)) < 0.7), own, along)

    def on(random: Random, n: int) -> Array:
        return start + steps(random, shape, n) * ways(random, np.tile(start, (n, 1)))

    return Place(name, on, ways)


def surface(shape: Shape) -> Place:
    """The surface of a shape, often where a plane of its frame cuts it; the directions touch it, or are normals."""
    centre, around = points(shape)[0], size(shape) or 1.0
    own = of_fields(shape)

    def on(random: Random, n: int) -> Array:
        chosen = random.integers(len(own), size=n)
        on_places = np.choose(chosen[:, None], [each.points(random, n) for each in own])
        anywhere = centre + around * random.uniform(-1, 1, (n, 3))
        found = surfaces([shape], np.where(random.random((n, 1)) < 0.5, on_places, anywhere)[None])[0][0]
        return np.where(np.isfinite(found), found, centre)

    def ways(random: Random, at: Array) -> Array:
        out, n = surfaces([shape], at[None])[1][0], len(at)
        axes = np.eye(3)[random.integers(3, size=n)]
        aside = np.cross(out, np.where(random.random((n, 1)) < 0.5, random_directions(random, n), axes))
        return np.where(random.random((n, 1)) < 0.3, out * random.choice([-1.0, 1.0], (n, 1)), aside)

    return Place("surface", on, ways)


def steps(random: Random, shape: Shape, n: int) -> Array:
    """Ways to go, (n, 1): round shares of the size of a shape, or any."""
    share = np.where(random.random((n, 1)) < 0.7, random.choice(STEPS, (n, 1)), random.uniform(0, 4, (n, 1)))
    return (size(shape) or 1.0) * share * random.choice([-1.0, 1.0], (n, 1))


def turns(random: Random, n: int) -> tuple[Array, Array]:
    """Cosines and sines of angles, (n, 1) each: of multiples of 90 degrees, of 3-4-5 triangles, or any."""
    angle = random.uniform(0, 2 * np.pi, n)
    anywhere = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    pair = np.where(random.random((n, 1)) < 0.7, TURNS[random.integers(len(TURNS), size=n)], anywhere)
    pair = pair * random.choice([-1.0, 1.0], (n, 2))
    return pair[:, :1], pair[:, 1:]


TINY = (0.0, 5e-324, 1e-310, 1e-300, 1e-20)  # components of directions that take the place of a 0


def snapped(shape: Shape, random: Random, n: int) -> tuple[Array, Array]:
    """Origins and unit directions of n rays, (n, 3) each."""
    special, around = places(shape), size(shape) or 1.0
    one, other = random.integers(len(special), size=(2, n))
    a, b = (chosen(which, [place.points(random, n) for place in special]) for which in (one, other))
    in_one = chosen(one, [place.ways(random, a) for place in special])
    in_other = chosen(other, [place.ways(random, b) for place in special])
    ways = [b - a, b - a, in_one, in_other, in_other, random_directions(random, n)]
    direction = chosen(random.integers(len(ways), size=n), ways)
    direction = np.where(np.isfinite(direction).all(axis=-1, keepdims=True), direction, 0.0)
    direction[~direction.any(axis=-1)] = 1.0, 0.0, 0.0
    direction = tilted(random, unit(direction))
    share = np.where(random.random((n, 1)) < 0.5, 2.0 ** random.integers(-3, 7, (n, 1)), 9 * random.random((n, 1)))
    origin = np.where(random.random((n, 1)) < 0.6, a, a - around * share * direction)
    return nudged(random, origin, around), direction


def chosen(which: Array, points: list[Array]) -> Array:
    """One of several (n, 3) for each ray."""
    found: Array = np.stack(points)[which, np.arange(len(which))]
    return found


def nudged(random: Random, points: Array, around: float) -> Array:
    """Half of the points by up to four units in the last place off, in some coordinates."""
    ulp = np.where(points == 0, U * around, np.spacing(np.abs(points)))
    return points + ulp * some_units(random, points)


def tilted(random: Random, directions: Array) -> Array:
    """Half of the directions by up to four units in the last place off, in some components; zeros of both signs."""
    tiny = np.where(random.random(directions.shape) < 0.5, U, random.choice(TINY, directions.shape))
    ulp = np.where(directions == 0, tiny, np.spacing(np.abs(directions)))
    tilt = directions + ulp * some_units(random, directions)
    return np.where(tilt == 0, random.choice([-1.0, 1.0], tilt.shape) * 0.0, unit(tilt))


def some_units(random: Random, points: Array) -> Array:
    units = random.integers(-4, 5, points.shape) * (random.random(points.shape) < 0.6)
    return np.where(random.random((len(points), 1)) < 0.5, units, 0)


ALIGNED = [tuple(sign * axis) for axis in np.eye(3) for sign in (1.0, -1.0)]
TURNED = sorted(  # by 3-4-5 triangles
    {turned for i, j in product((3.0, -3.0), (4.0, -4.0)) for turned in permutations((i / 5, j / 5, 0.0))}
)
LENGTHS = (0.5, 1.0, 1.25, 2.0, 2.5, 3.0, 4.0, 5.0)
SCALES = (1.0, 1.0, 1.0, 1.0, 2.0**-40, 2.0**40, 1e-9, 1e9)
OFFSETS = (0.0, 0.0, 1.0, 1.0, 2.0**10, 2.0**20)  # in scales


def pose(kind: Kind, random: Random) -> Shape:
    """A shape of round lengths at a round place: upright, turned by a 3-4-5 triangle, far away, tiny or huge; one of
    eight is a general one."""
    scale, offset = random.choice(SCALES), random.choice(OFFSETS)
    middle = scale * (offset if scale * offset < FARTHEST / 100 else 1.0) * random.integers(-8, 9, 3)
    general = random.random() < 1 / 8
    placed = [each for each in fields_of(kind.element) if not each.keyed]
    value_of = random_value if general else round_value
    while True:
        with suppress(ElementError):  # fields that contradict each other
            shape = kind.element(**{each.name: value_of(each, random, scale, middle) for each in placed})
            if not (isinstance(shape, Torus) and shape.tube == shape.diameter):  # a thicker one has a cavity
                return shape


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
