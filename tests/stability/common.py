"""Execution modes of formulas, `minirt.trace` included, and the regimes of every kind of shape.

They are made from its declared fields. Lengths are in sizes of the shape.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

import numpy as np
from gmpy2 import sqrt

import minirt
from minirt.element import fields_of
from minirt.errors import ElementError
from minirt.fields import FARTHEST, Length, Lengths
from minirt.fields.scalars import SMALLEST
from minirt.scene import Camera, Scene
from minirt.shapes import Cone, Cylinder, Ellipsoid, Hyperboloid, Kind, Paraboloid, Shape, Sphere, Torus
from tests.oracle.body import body, dot, exact, gradient
from tests.shapes.examples import example, on_surface, place
from tests.shapes.execution_modes import Intersect, compiled, on_arrays
from tests.shapes.regimes import RAYS, Array, Random, Rays, log_uniform, random_directions, random_perpendiculars, unit
from tests.stability.regime import Regime, surfaces_at

EYE = Camera((0, 0, 0), (0, 0, 1), 60)


def traced(rays: Rays) -> tuple[Array, Array, Array]:
    """Distances, points and normals by `minirt.trace`, each shape in a scene of its own."""
    hits = [minirt.trace(Scene((EYE, shape)), *each) for shape, *each in zip(*rays, strict=True)]
    distances, _, points, normals = map(np.stack, zip(*hits, strict=True))
    return distances, points, normals


def interpreted(rays: Rays, intersect: Intersect = on_arrays) -> tuple[Array, Array, Array]:
    """Distances, points and normals by the interpreted formulas."""
    t = intersect(*rays)
    return t, *surfaces_at(rays, t)


MODES: dict[str, Intersect] = {
    "arrays": on_arrays,
    "compiled": compiled,
    "traced": lambda *rays: traced(Rays(*rays))[0],
}

COUNT = 8  # shapes of a regime
QUADRICS = (Sphere, Cylinder, Cone, Paraboloid, Hyperboloid, Ellipsoid)
CURVED = (*QUADRICS, Torus)


def towards(
    kind: Kind,
    seed: int,
    far: tuple[float, float] = (3.0, 20.0),
    size: float = 1.0,
    offset: float = 0.0,
    count: int = COUNT,
) -> Rays:
    """Rays from `far` sizes away at points in and around shapes of a `size`, in a scene at `offset`."""
    random = np.random.default_rng(seed)
    shapes = [example(kind, random, size, offset) for _ in range(count)]
    middles = places(shapes)
    origins = middles + size * log_uniform(random, *far, count, RAYS, 1) * random_directions(random, count, RAYS)
    targets = middles + size * random.uniform(-0.6, 0.6, (count, RAYS, 3))
    return Rays(shapes, origins, unit(targets - origins))


Make = Callable[[Random], Shape]
Shots = Callable[[Random, Any], tuple[Array, Array]]  # origins and directions of rays at a shape, (RAYS, 3) each


def shots(seed: int, make: Make, rays: Shots, count: int = COUNT) -> Rays:
    """Rays at each of some random shapes."""
    random = np.random.default_rng(seed)
    shapes, found = [], []
    for _ in range(count):
        shapes.append(make(random))
        found.append(rays(random, shapes[-1]))
    origins, directions = np.swapaxes(found, 0, 1)
    return Rays(shapes, origins, directions)


def sign(random: Random) -> Array:
    return random.choice([-1.0, 1.0], (RAYS, 1))


def touching(random: Random, shape: Shape) -> tuple[Array, Array]:
    """Rays along the surface, 1e-16 to 1e-4 sizes above or below it."""
    on, out = on_surface(shape, random)
    side = sign(random)
    directions = unit(np.cross(out, random_directions(random, RAYS)))
    touch = on + side * log_uniform(random, 1e-16, 1e-4, RAYS, 1) * out
    return touch - random.uniform(3, 20, (RAYS, 1)) * directions, directions


def leaving(random: Random, shape: Shape) -> tuple[Array, Array]:
    """Rays from 1e-12 to 1e-3 above and below the surface, in all directions."""
    on, out = on_surface(shape, random)
    return on + sign(random) * log_uniform(random, 1e-12, 1e-3, RAYS, 1) * out, random_directions(random, RAYS)


def nearest_on_surface(shape: Shape, point: Array) -> list[float]:
    """The point of a solid's surface next to a point beside it, rounded once."""
    p = exact(point.tolist())
    slopes = [gradient(wall, p) for wall in body(shape).walls]
    steps = [(wall(p) / dot(slope, slope), slope) for wall, slope in zip(body(shape).walls, slopes, strict=True)]
    step, slope = min(steps, key=lambda each: abs(each[0]) * sqrt(dot(each[1], each[1])))
    return [float(x - step * part) for x, part in zip(p, slope, strict=True)]


def starting(random: Random, shape: Shape) -> tuple[Array, Array]:
    """Rays from points of the surface, rounded, in all directions."""
    on, _ = on_surface(shape, random)
    return np.array([nearest_on_surface(shape, point) for point in on]), random_directions(random, RAYS)


def from_above(random: Random, shape: Shape) -> tuple[Array, Array]:
    """Rays down onto a huge shape, from 1e-6 to 1 above it."""
    on, out = on_surface(shape, random)
    origins = on + log_uniform(random, 1e-6, 1.0, RAYS, 1) * out
    return origins, unit(random_perpendiculars(random, out) - random.uniform(0.1, 10, (RAYS, 1)) * out)


def places(shapes: list[Shape]) -> Array:
    return np.stack([place(shape) for shape in shapes])[:, None]


def is_solid(kind: Kind) -> bool:
    return body(example(kind, np.random.default_rng(1))).solid


def common(kind: Kind) -> list[Regime]:
    """The regimes that every kind of shape has."""
    made, plain = partial(towards, kind), partial(example, kind)
    regimes = [
        Regime("usual", partial(made, 1)),
        Regime("a million sizes away", partial(made, 2, (1e2, 1e6))),
        Regime("a scene at 1e6", partial(made, 10, offset=1e6)),
        Regime("a scene at 1e8", partial(made, 3, offset=1e8)),
        Regime("a size of 1e-6, seen from 1e6", partial(made, 4, (1e11, 1e12), 1e-6)),
        Regime("the least size", partial(made, 5, size=5 * SMALLEST)),
        Regime("the greatest size", partial(made, 6, size=FARTHEST / 5)),
        Regime("from the middle", partial(made, 7, (1e-9, 0.1))),
    ]
    if is_solid(kind):
        regimes += [
            Regime("along the surface", partial(shots, 8, plain, touching)),
            Regime("beside the surface", partial(shots, 9, plain, leaving)),
        ]
    if kind.element in CURVED:
        far = partial(example, kind, size=1.0, offset=1e4)
        regimes += [
            Regime("on the surface", partial(shots, 12, plain, starting), nearest=1e-9),
            Regime("on the surface, a scene at 1e4", partial(shots, 13, far, starting), nearest=1e-9),
        ]
    if kind.element in QUADRICS and kind.element is not Ellipsoid:  # whose frame is known to rounding
        huge = partial(example, kind, size=2e8)
        regimes.append(Regime("just above a huge one", partial(shots, 14, huge, from_above), 1e-9))
    return regimes


Spot = Callable[[Random, Any], Array]  # (RAYS, 3): points of a shape, or directions


def at(seed: int, make: Make, spot: Spot, off: tuple[float, float] = (1e-16, 1e-6), count: int = COUNT) -> Rays:
    """Rays from everywhere at points of shapes, missing them by a distance in `off`."""

    def rays(random: Random, shape: Shape) -> tuple[Array, Array]:
        target = spot(random, shape) + log_uniform(random, *off, RAYS, 1) * random_directions(random, RAYS)
        directions = random_directions(random, RAYS)
        return target - random.uniform(3, 20, (RAYS, 1)) * directions, directions

    return shots(seed, make, rays, count)


def along(seed: int, make: Make, way: Spot, off: tuple[float, float] | None = None, offset: float = 0.0) -> Rays:
    """Rays along directions, or off them by an angle (radians) in `off`, at points in and around shapes."""

    def moved(random: Random) -> Shape:
        shape = make(random)
        return shape.replace(**{points(shape)[0]: tuple(offset * random_directions(random))}) if offset else shape

    def rays(random: Random, shape: Shape) -> tuple[Array, Array]:
        exact = way(random, shape)
        angle = log_uniform(random, *off, RAYS, 1) if off else 0.0
        directions = unit(exact + angle * random_directions(random, RAYS))
        return place(shape) + random.uniform(-0.6, 0.6, (RAYS, 3)) - random.uniform(0, 9, (RAYS, 1)) * exact, directions

    return shots(seed, moved, rays)


def pose_of(random: Random) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """A random point near the origin and a random direction: where a shape is, and its axis or normal."""
    return tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1))


def points(shape: Shape) -> list[str]:
    return [name for name in ("centre", "apex", "vertex") if hasattr(shape, name)]


def axis_of(shape: Shape) -> Array:
    return np.array(shape.axis)


def edge(middle: Array, shape: Shape, radius: float, random: Random) -> Array:
    """Random points of a circle about a point of the axis of a shape."""
    return middle + radius * random_perpendiculars(random, axis_of(shape), RAYS)


FEW = 4  # shapes of a regime


def stretched(shape: Shape, name: str, factor: float) -> Shape:
    """A shape with one length multiplied by a factor; of three lengths the second."""
    value = getattr(shape, name)
    new = (value[0], factor * value[1], value[2]) if isinstance(value, tuple) else factor * value
    return shape.replace(**{name: new})


def seen(kind: Kind, seed: int, name: str, factor: float) -> Rays:
    """Rays from inside, and from 3 to 20 away at points inside; both mostly far from the middle."""
    random = np.random.default_rng(seed)
    shapes: list[Shape] = []
    while len(shapes) < FEW:
        with suppress(ElementError):
            shapes.append(stretched(example(kind, random), name, factor))
    places = np.stack([within(shape, random) for shape in shapes])
    directions = random_directions(random, FEW, RAYS)
    away = np.where(np.arange(RAYS)[:, None] % 2, random.uniform(3, 20, (FEW, RAYS, 1)), 0.0)
    return Rays(shapes, places - away * directions, directions)


def within(shape: Shape, random: Random) -> Array:
    """Random points in the hull of a shape's balls, (RAYS, 3)."""
    centres = np.array([centre for centre, _ in shape.balls()])
    radii = np.array([radius for _, radius in shape.balls()])
    shares = random.dirichlet(np.ones(len(centres)), RAYS)
    return shares @ centres + 0.7 * (shares @ radii)[:, None] * random.random((RAYS, 1)) * random_directions(
        random, RAYS
    )


def stretched_regimes(kind: Kind) -> list[Regime]:
    """The regimes of a kind of solid; an answer must lie between those for a thicker and a thinner shape."""
    found = []
    for field in fields_of(kind.element):
        if field.keyed or not isinstance(field, (Length, Lengths)):
            continue
        for factor in (1e-9, 1e9):
            with suppress(ElementError):
                stretched(example(kind, np.random.default_rng(1)), field.name, factor)
                make = partial(seen, kind, 21, field.name, factor)
                found.append(Regime(f"{field.title} times {factor:g}", make))
    return found
