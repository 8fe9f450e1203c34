"""Rays from points on a surface or within 1e-9 of it, rays at the rims of small shapes far away, and rays sent on from
hits: the backward errors of their hits, wrong answers, and hits of the surface that a ray has just left.

`python -m tests.stability.test_close_rays [--seed N] [--rays N] [NAME ...]` prints the table of all cases, or of those
whose names contain a word.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import minirt
from minirt.scene import Camera, Scene
from minirt.shapes import Shape
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.sphere import Sphere
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle
from tests.shapes.examples import place
from tests.shapes.regimes import GREY, Array, Random, log_uniform, random_directions, random_perpendiculars, unit
from tests.stability import regime
from tests.stability.common import nearest_on_surface
from tests.stability.degenerate import Wrong, judged
from tests.stability.regime import BOUND, U, size

EYE = Camera((0, 0, 0), (0, 0, 1), 60)
EACH = 100  # rays of a shape
STEEP = 2.0**-16  # cosine of ray and normal: a ray that starts on a surface and is flatter touches it, to rounding
AGAIN = 64.0  # roundings of the start's height above the surface, within which a hit is that of the start
Shots = tuple[Array, Array]  # origins and directions, (n, 3) each


class Case(NamedTuple):
    """A recipe for shapes, and for rays at one of them."""

    name: str
    make: Callable[[Random], Shape]
    rays: Callable[[Random, Any], Shots]
    sent_on: bool = False  # whether the rays are sent on from where they hit, and these rays are judged


class Row(NamedTuple):
    """What the rays of a case have met."""

    name: str
    rays: int
    hits: int
    largest: float  # backward error, in 60 digits
    above: int  # hits with a larger backward error than the bound
    again: int  # hits of the surface on which their ray starts, where they start
    wrong: int  # answers that are wrong for a thicker and a thinner shape, too
    worst: str  # the shape and the ray of the largest backward error, or of the first wrong answer

    def __str__(self) -> str:
        figures = f"{self.rays:6d} {self.hits:6d} {self.largest:9.3g} {self.above:6d} {self.again:6d} {self.wrong:6d}"
        return f"{self.name:58s} {figures}"


HEAD = f"{'case':58s} {'rays':>6s} {'hits':>6s} {'largest':>9s} {'above':>6s} {'again':>6s} {'wrong':>6s}"


def measured(case: Case, seed: int, rays: int) -> Row:
    """Trace the rays of a case and judge what they meet."""
    random = np.random.default_rng(seed)
    met = Row(case.name, 0, 0, 0.0, 0, 0, 0, "")
    for _ in range(-(-rays // EACH)):
        met = with_shape(met, case, case.make(random), random)
    return met


def with_shape(met: Row, case: Case, shape: Shape, random: Random) -> Row:
    """A row with the rays at one more shape."""
    scene = Scene((EYE, shape))
    origins, directions = case.rays(random, shape)
    normals = np.full(origins.shape, np.nan)  # of the surface where a ray starts
    if case.sent_on:
        first = minirt.trace(scene, origins, directions)
        hit = first.owner >= 0
        origins, normals = first.point[hit], first.normal[hit]
        directions = onward(random, origins, inner(random, shape, len(origins)))
    hits = minirt.trace(scene, origins, directions)
    hit = np.isfinite(hits.distance)
    errors = np.where(hit, hits.backward_error, 0.0)
    for i in np.argsort(-errors)[:40]:
        if errors[i] > 1:
            exact = regime.certificate(shape, origins[i], directions[i], hits.distance[i], hits.normal[i])
            errors[i] = exact.backward_error if exact else errors[i]
    magnitude = hits.distance + np.linalg.norm(origins - regime.points(shape)[0], axis=1) + size(shape)
    slope = np.abs((directions * normals).sum(axis=1))
    same = (hits.normal * normals).sum(axis=1) > 0.5
    again = hit & same & (slope > STEEP) & (hits.distance * slope <= AGAIN * U * magnitude)
    wrong = judged(shape, origins, directions, hits.distance, 20)
    worst = met.worst
    if len(errors) and errors.max() > max(met.largest, BOUND):
        i = int(np.argmax(errors))
        t, exact = float(hits.distance[i]), float(errors[i])
        worst = f"error {exact:.3g}: {Wrong(shape, origins[i].tolist(), directions[i].tolist(), t, t, False)}"
    elif not worst:
        worst = str(wrong[0]) if wrong else ""
    return Row(
        met.name,
        met.rays + len(origins),
        met.hits + int(hit.sum()),
        max(met.largest, float(errors.max(initial=0.0))),
        met.above + int((errors > BOUND).sum()),
        met.again + int(again.sum()),
        met.wrong + len(wrong),
        worst,
    )


def onward(random: Random, starts: Array, targets: Array) -> Array:
    """Directions from points of a shape: anywhere, and half of them at targets."""
    anywhere = random_directions(random, len(starts))
    return np.where(random.random((len(starts), 1)) < 0.5, anywhere, unit(targets - starts))


def inner(random: Random, shape: Shape, count: int) -> Array:
    """Random points in the hull of a shape's balls."""
    centres, radii = (np.array(each) for each in zip(*shape.balls(), strict=True))
    share = random.dirichlet(np.full(len(centres), 0.5), count)
    return np.asarray(
        share @ centres + 0.9 * (share @ radii)[:, None] * random.random((count, 1)) * random_directions(random, count)
    )


def pose(random: Random, offset: float = 1.0) -> tuple[Any, Any]:
    """A random point about so far from the origin of the scene, and a random direction."""
    return tuple(offset * random_directions(random)), tuple(random_directions(random).clip(-1, 1))


def hyperboloid(random: Random, waist: float, scale: float = 1.0) -> Hyperboloid:
    widest, height = scale * random.uniform(0.5, 2, 2)
    return Hyperboloid(*pose(random), waist * widest, widest, height, GREY)


def needle(random: Random, thin: float) -> Ellipsoid:
    long = random.uniform(0.5, 2)
    sizes = [thin * long * random.uniform(0.5, 2), long, thin * long * random.uniform(0.5, 2)]
    return Ellipsoid(*pose(random), tuple(random.permutation(sizes)), GREY, roll=random.uniform(0, 360))


def round_about(random: Random, kind: type[Shape], scale: float = 1.0, offset: float = 1.0) -> Shape:
    """A shape with a point, an axis and two lengths, of about a size."""
    return kind(*pose(random, offset), *(scale * random.uniform(0.5, 2, 2)), GREY)


def ball(random: Random) -> Sphere:
    return Sphere(pose(random)[0], random.uniform(0.5, 2), GREY)


def ring(random: Random) -> Torus:
    wide = random.uniform(0.5, 2)
    return Torus(*pose(random), wide, wide * random.uniform(0.1, 1), GREY)


def triangle(random: Random, thin: float) -> Triangle:
    a, along = random.normal(size=3), random_directions(random)
    c = a + random.uniform(0, 1) * along + thin * random_perpendiculars(random, along)
    return Triangle(*map(tuple, random.permutation([a, a + along, c]).tolist()), GREY)


def side_of(random: Random, shape: Hyperboloid) -> Array:
    """Random points of the side of a hyperboloid, half of them at heights down to those of its waist."""
    share = np.where(random.random((EACH, 1)) < 0.5, random.random((EACH, 1)), log_uniform(random, 1e-9, 1, EACH, 1))
    radius = np.hypot(shape.waist / 2, share * np.sqrt(shape.diameter**2 - shape.waist**2) / 2)
    axis = np.array(shape.axis)
    up = share * shape.height / 2 * random.choice([-1.0, 1.0], (EACH, 1))
    return np.asarray(shape.centre + up * axis + radius * random_perpendiculars(random, axis, EACH))


def skin_of(random: Random, shape: Ellipsoid) -> Array:
    """Random points of an ellipsoid."""
    z, x, y = shape.frame()
    half, axes = np.array(shape.sizes) / 2, np.array([[v.x, v.y, v.z] for v in (x, y, z)])
    return np.asarray(shape.centre + (half * random_directions(random, EACH)) @ axes)


def beside(spots: Callable[[Random, Any], Array], random: Random, shape: Any) -> Shots:
    """Rays from points of the surface, rounded; half of them from up to 1e-9 sizes above or below it."""
    on = np.array([nearest_on_surface(shape, point) for point in spots(random, shape)])
    off = size(shape) * log_uniform(random, 1e-17, 1e-9, EACH, 1) * random_directions(random, EACH)
    starts = np.where(random.random((EACH, 1)) < 0.5, on, on + off)
    return starts, onward(random, starts, spots(random, shape))


def aimed(random: Random, shape: Shape) -> Shots:
    """Rays from up to ten sizes away at points within a shape."""
    reach = size(shape) * log_uniform(random, 0.1, 10, EACH, 1)
    origins = place(shape) + reach * random_directions(random, EACH)
    return origins, unit(inner(random, shape, EACH) - origins)


def at_edges(random: Random, shape: Triangle) -> Shots:
    """Rays at the edges of a triangle, off them by roundings, also at small slopes to it."""
    corners = np.array([shape.a, shape.b, shape.c])
    start, share = random.integers(3, size=EACH), random.random((EACH, 1))
    target = share * corners[start] + (1 - share) * corners[(start + 1) % 3]
    target += log_uniform(random, 1e-18, 1e-12, EACH, 1) * random_directions(random, EACH)
    slope = log_uniform(random, 1e-9, 1, EACH, 1) * random.choice([-1.0, 1.0], (EACH, 1))
    normal = np.array(shape.normal())
    directions = unit(random_perpendiculars(random, normal, EACH) + slope * normal)
    return target - log_uniform(random, 0.01, 10, EACH, 1) * directions, directions


def at_rims(ends: tuple[float, ...], distance: float, random: Random, shape: Any) -> Shots:
    """Rays from so far away at the rims of a shape, which are at these shares of its height."""
    axis = np.array(shape.normal if isinstance(shape, Disc) else shape.axis)
    up = getattr(shape, "height", 0.0) * random.choice(ends, (EACH, 1)) * axis
    target = regime.points(shape)[0] + up + shape.diameter / 2 * random_perpendiculars(random, axis, EACH)
    target += size(shape) * log_uniform(random, 1e-17, 1e-3, EACH, 1) * random_directions(random, EACH)
    origins = target + distance * random.uniform(0.5, 1, (EACH, 1)) * random_directions(random, EACH)
    return origins, unit(target - origins)


RIMS = {Disc: (0.0,), Cylinder: (-0.5, 0.5), Cone: (1.0,), Paraboloid: (1.0,), Hyperboloid: (-0.5, 0.5)}


def rimmed(kind: type[Shape], scale: float, offset: float, random: Random) -> Any:
    """A shape of a size so far from the origin of the scene."""
    lengths = [*scale * random.uniform(0.5, 2, 2)]
    if kind is Hyperboloid:
        lengths.insert(0, lengths[0] * random.uniform(0.1, 1))
    return kind(*pose(random, offset), *(lengths[:1] if kind is Disc else lengths), GREY)


def cases() -> Iterator[Case]:
    for waist in (1e-2, 1e-4, 1e-8):
        yield Case(
            f"hyperboloid with a waist of {waist:g}, from its side",
            partial(hyperboloid, waist=waist),
            partial(beside, side_of),
        )
    for thin in (1e-2, 1e-4, 1e-6):
        yield Case(
            f"ellipsoid needle of 1:{1 / thin:g}, from its surface",
            partial(needle, thin=thin),
            partial(beside, skin_of),
        )
    for thin in (1.0, 1e-3, 1e-6):
        yield Case(f"triangle {thin:g} high, at its edges", partial(triangle, thin=thin), at_edges)
    for scale, offset, distance in ((1e-8, 4.0, 1e-7), (1e-8, 4.0, 4.0), (1.0, 1e12, 10.0), (1.0, 1e12, 1e12)):
        for kind, ends in RIMS.items():
            yield Case(
                f"{kind.title} {scale:g} across at {offset:g}, rim seen from {distance:g}",
                partial(rimmed, kind, scale, offset),
                partial(at_rims, ends, distance),
            )
    sent_on: dict[str, Callable[[Random], Shape]] = {
        "sphere": ball,
        "torus": ring,
        **{each.title: partial(round_about, kind=each) for each in (Cylinder, Cone, Paraboloid)},
        "flat cylinder": lambda random: Cylinder(*pose(random), 1, log_uniform(random, 1e-9, 1e-3), GREY),
        "thin cylinder": lambda random: Cylinder(*pose(random), log_uniform(random, 1e-9, 1e-3), 1, GREY),
        "thin cone": lambda random: Cone(*pose(random), log_uniform(random, 1e-6, 1e-2), 1, GREY),
        "blunt cone": lambda random: Cone(*pose(random), 1, log_uniform(random, 1e-6, 1e-2), GREY),
        "hyperboloid": lambda random: hyperboloid(random, random.uniform(0.1, 1)),
        "hyperboloid with a thin waist": lambda random: hyperboloid(random, log_uniform(random, 1e-8, 1e-1)),
        "ellipsoid": partial(needle, thin=0.8),
        "ellipsoid needle": lambda random: needle(random, log_uniform(random, 1e-6, 1e-1)),
    }
    for name, make in sent_on.items():
        yield Case(f"{name}, from points that were hit", make, aimed, sent_on=True)


CASES = list(cases())


def main() -> int:
    """Print the table of the cases that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="of the names of the cases")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rays", type=int, default=2000, help="of each case")
    parser.add_argument("--worst", action="store_true", help="show the worst ray of each case")
    chosen = parser.parse_args()
    print(HEAD)
    for case in CASES:
        if not chosen.words or any(word in case.name for word in chosen.words):
            row = measured(case, chosen.seed, chosen.rays)
            print(row, flush=True)
            if chosen.worst and row.worst:
                print("    " + row.worst)
    return 0


if __name__ == "__main__":
    sys.exit(main())
