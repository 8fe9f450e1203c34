"""Regimes of every kind of shape, made from its declared fields. Lengths are in sizes of the shape."""

from __future__ import annotations

from functools import partial

import numpy as np
from gmpy2 import sqrt

from minirt.shapes import Kind, Shape
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.sphere import Sphere
from minirt.shapes.torus import Torus
from tests import oracle
from tests.oracle.body import body, gradient
from tests.oracle.vectors import dot, exact
from tests.shapes.examples import example, on_surface, place
from tests.shapes.regimes import RAYS, Array, Rays, log_uniform, random_directions, random_perpendiculars, unit
from tests.stability.regime import Regime

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


def touching(kind: Kind, seed: int) -> Rays:
    """Rays along the surface, 1e-16 to 1e-4 sizes above or below it."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        shape = example(kind, random)
        on, out = on_surface(shape, random)
        sign = random.choice([-1.0, 1.0], (RAYS, 1))
        directions[i] = unit(np.cross(out, random_directions(random, RAYS)))
        touch = on + sign * log_uniform(random, 1e-16, 1e-4, RAYS, 1) * out
        origins[i] = touch - random.uniform(3, 20, (RAYS, 1)) * directions[i]
        shapes.append(shape)
    return Rays(shapes, origins, directions)


def leaving(kind: Kind, seed: int, height: tuple[float, float] = (1e-12, 1e-3)) -> Rays:
    """Rays from closely above and below the surface, in all directions."""
    random = np.random.default_rng(seed)
    shapes, origins = [], np.empty((COUNT, RAYS, 3))
    for i in range(COUNT):
        shape = example(kind, random)
        on, out = on_surface(shape, random)
        origins[i] = on + random.choice([-1.0, 1.0], (RAYS, 1)) * log_uniform(random, *height, RAYS, 1) * out
        shapes.append(shape)
    return Rays(shapes, origins, random_directions(random, COUNT, RAYS))


def nearest_on_surface(shape: Shape, point: Array) -> list[float]:
    """The point of a solid's surface next to a point beside it, rounded once."""
    p = exact(point.tolist())
    slopes = [gradient(wall, p) for wall in body(shape).walls]
    steps = [(wall(p) / dot(slope, slope), slope) for wall, slope in zip(body(shape).walls, slopes, strict=True)]
    step, slope = min(steps, key=lambda each: abs(each[0]) * sqrt(dot(each[1], each[1])))
    return [float(x - step * part) for x, part in zip(p, slope, strict=True)]


def starting(kind: Kind, seed: int, offset: float = 0.0) -> Rays:
    """Rays from points of the surface, rounded, in all directions."""
    random = np.random.default_rng(seed)
    shapes, origins = [], np.empty((COUNT, RAYS, 3))
    for i in range(COUNT):
        shapes.append(example(kind, random, 1.0, offset))
        on, _ = on_surface(shapes[i], random)
        origins[i] = [nearest_on_surface(shapes[i], point) for point in on]
    return Rays(shapes, origins, random_directions(random, COUNT, RAYS))


def from_above(kind: Kind, seed: int, size: float = 1e9, height: tuple[float, float] = (1e-6, 1.0)) -> Rays:
    """Rays down onto shapes of a huge `size`, from a `height` above them."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        shapes.append(example(kind, random, size))
        on, out = on_surface(shapes[i], random)
        origins[i] = on + log_uniform(random, *height, RAYS, 1) * out
        directions[i] = unit(random_perpendiculars(random, out) - random.uniform(0.1, 10, (RAYS, 1)) * out)
    return Rays(shapes, origins, directions)


def places(shapes: list[Shape]) -> Array:
    return np.stack([place(shape) for shape in shapes])[:, None]


def common(kind: Kind) -> list[Regime]:
    """The regimes that every kind of shape has."""
    made = partial(towards, kind)
    solid = body(example(kind, np.random.default_rng(1))).solid
    regimes = [
        Regime("usual", partial(made, 1)),
        Regime("a million sizes away", partial(made, 2, (1e2, 1e6))),
        Regime("a scene at 1e6", partial(made, 10, offset=1e6)),
        Regime("a scene at 1e8", partial(made, 3, offset=1e8)),
        Regime("a size of 1e-6, seen from 1e6", partial(made, 4, (1e11, 1e12), 1e-6)),
        Regime("a size of 1e-12", partial(made, 5, size=1e-12)),
        Regime("a size of 1e12", partial(made, 6, size=1e12)),
        Regime("from the middle", partial(made, 7, (1e-9, 0.1))),
    ]
    if solid:
        regimes += [
            Regime("along the surface", partial(touching, kind, 8)),
            Regime("beside the surface", partial(leaving, kind, 9), blur=np.inf),
        ]
    if kind.element in CURVED:
        regimes += [
            Regime("on the surface", partial(starting, kind, 12), nearest=oracle.onward),
            Regime("on the surface, a scene at 1e4", partial(starting, kind, 13, 1e4), nearest=oracle.onward),
        ]
    if kind.element in QUADRICS:
        regimes.append(Regime("just above a huge one", partial(from_above, kind, 14), 1e-9, 0.0))
    return regimes
