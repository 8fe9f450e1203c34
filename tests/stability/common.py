"""Regimes common to all shapes, made from their declared fields. Lengths are in units of the shape's size."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes import Kind, Shape
from tests import oracle
from tests.oracle.body import body
from tests.shapes.examples import example, place
from tests.shapes.regimes import RAYS, Array, Rays, log, unit, ways
from tests.stability.regime import Regime

COUNT = 8  # shapes per regime


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
    origins = middles + size * log(random, *far, count, RAYS, 1) * ways(random, count, RAYS)
    targets = middles + size * random.uniform(-0.6, 0.6, (count, RAYS, 3))
    return Rays(shapes, origins, unit(targets - origins))


def touching(kind: Kind, seed: int) -> Rays:
    """Rays along the surface, 1e-16 to 1e-4 sizes above and below it."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        shape = example(kind, random)
        on, out = on_surface(shape, random)
        sign = random.choice([-1.0, 1.0], (RAYS, 1))
        directions[i] = unit(np.cross(out, ways(random, RAYS)))
        touch = on + sign * log(random, 1e-16, 1e-4, RAYS, 1) * out
        origins[i] = touch - random.uniform(3, 20, (RAYS, 1)) * directions[i]
        shapes.append(shape)
    return Rays(shapes, origins, directions)


def leaving(kind: Kind, seed: int, height: tuple[float, float] = (1e-12, 1e-3)) -> Rays:
    """Rays in all directions from just above and just below the surface."""
    random = np.random.default_rng(seed)
    shapes, origins = [], np.empty((COUNT, RAYS, 3))
    for i in range(COUNT):
        shape = example(kind, random)
        on, out = on_surface(shape, random)
        origins[i] = on + random.choice([-1.0, 1.0], (RAYS, 1)) * log(random, *height, RAYS, 1) * out
        shapes.append(shape)
    return Rays(shapes, origins, ways(random, COUNT, RAYS))


def on_surface(shape: Shape, random: np.random.Generator) -> tuple[Array, Array]:
    """Return points on the surface of a shape of size 1 and the normals there, (RAYS, 3) each."""
    found = []
    while len(found) < RAYS:
        origin = place(shape) + log(random, 0.1, 10) * ways(random)
        direction = unit(place(shape) + random.uniform(-0.6, 0.6, 3) - origin)
        t = oracle.nearest(shape, origin, direction)
        if t is not None:
            point = origin + float(t) * direction
            found.append((point, [float(x) for x in oracle.normal(shape, point)]))
    on, out = np.array(found).swapaxes(0, 1)
    return on, out


def places(shapes: list[Shape]) -> Array:
    return np.stack([place(shape) for shape in shapes])[:, None]


def common(kind: Kind) -> list[Regime]:
    """Return the common regimes of a shape type."""
    rays = partial(towards, kind)
    solid = body(example(kind, np.random.default_rng(1))).solid
    regimes = [
        Regime("usual", partial(rays, 1)),
        Regime("a million sizes away", partial(rays, 2, (1e2, 1e6))),
        Regime("a scene at 1e6", partial(rays, 10, offset=1e6)),
        Regime("a scene at 1e8", partial(rays, 3, offset=1e8)),
        Regime("a size of 1e-6, seen from 1e6", partial(rays, 4, (1e11, 1e12), 1e-6)),
        Regime("a size of 1e-12", partial(rays, 5, size=1e-12)),
        Regime("a size of 1e12", partial(rays, 6, size=1e12)),
        Regime("from the middle", partial(rays, 7, (1e-9, 0.1))),
    ]
    if solid:
        regimes += [
            Regime("along the surface", partial(touching, kind, 8), blur=1e-6),
            Regime("beside the surface", partial(leaving, kind, 9), tolerance=1e-13, blur=np.inf),
        ]
    return regimes
