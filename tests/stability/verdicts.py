"""Verdicts on answers: right are those that are exact for a ray and a shape within 64 roundings of the given ones.

A rounding is 2^-53 of the sum of t, of the distance from the ray's origin to the shape, and of the shape's size. The
oracle cuts a ray into pieces inside and outside of a solid, and a piece counts if somewhere in it the ray is farther
than 64 roundings from the surface. A hit is right if it lies within that of the surface, and before the place where the
ray is deepest in the first piece that counts and is on the other side than the start. A miss is right if there is no
such piece. A sheet has no inside: a hit is right within 64 roundings of its plane and of its edges, and a miss if a ray
so close to the given one passes beside it.

A ray that starts within 8 roundings of its coordinates of the surface starts on it. It may start on either side, and it
must not hit the surface where it starts; a sheet it does not hit at all. One that is flatter than 2^-10, or than its
start is known on the scale of the shape, only touches.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.queries import certificates
from minirt.scene.writer import line_of
from minirt.shapes import Shape
from tests import oracle
from tests.oracle import Crossed
from tests.shapes.execution_modes import surfaces
from tests.shapes.regimes import Array

Mask = NDArray[np.bool_]
U = 2.0**-53
SLACK = 64 * U
START = 8 * U  # of the largest coordinate of a start
STEEP = 2.0**-10
BOUND = 4.0  # of the backward error of any hit by each face


def right(shape: Shape, origins: Array, directions: Array, t: Array, digits: bool = False) -> Mask:
    """Which of the answers t of n rays, infinity for a miss, are right."""
    rays, hit = Crossed(shape, origins, directions, digits), np.isfinite(t)
    first = oracle.points(shape)[0]
    reach = np.linalg.norm(origins - first, axis=1) + oracle.size(shape)
    with np.errstate(all="ignore"):
        at, start = rays.heights(np.where(hit, t, 0.0)), rays.heights(np.zeros(len(t)))
        rounding = START * np.maximum(np.abs(origins), np.abs(origins - first)).max(axis=1)
        band = SLACK * (np.where(hit, t, 0.0) + reach)
        if oracle.is_sheet(shape):
            slope = np.abs(np.einsum("ij,ji->i", directions, start.normals[0]))
            starts = np.abs(start.faces[0]) <= rounding
            exact = rays.zeros[0][0]
            play = (band + SLACK * np.abs(exact)) / slope
            surely = exact - 2 * play > 0
            for side in (-1, 0, 1):
                surely &= rays.heights(exact + side * play).beyond < -band
            near = (np.abs(at.faces[0]) <= band) & (at.beyond <= band) & (t > 0)
            return np.where(
                hit, near & ~(starts & (np.abs(start.faces[0]) < rounding / 2)), ~surely | (slope <= SLACK) | starts
            )
        starts = np.abs(start.above) <= 2 * rounding
        blur = np.where(starts, 2 * rounding, 0.0)
        cuts, above, where = rays.pieces(np.zeros(len(t)))
        counts = np.abs(above) > SLACK * (np.abs(cuts[:-1]) + reach) + blur
        inside = above < 0
        begin = np.take_along_axis(inside, counts.argmax(axis=0)[None], axis=0)[0]
        turned = counts & (inside != begin)
        turn = np.where(turned.any(axis=0), np.take_along_axis(where, turned.argmax(axis=0)[None], axis=0)[0], np.inf)
        good = np.where(hit, (t > 0) & (np.abs(at.above) <= band + blur) & (t < turn), np.isinf(turn) & ~np.isnan(t))
        # A hit where the ray starts must be another crossing than that of the start, or the ray starts beside an apex.
        steep = np.abs(np.einsum("kjn,nj->kn", start.normals[: len(start.faces)], directions))
        near = np.abs(start.faces) <= 8 * rounding
        slope, steepest = np.where(near, steep, 1.0).min(axis=0), np.where(near, steep, 0.0).max(axis=0)
        again = (np.abs(start.above) <= rounding / 4) & (start.beyond <= -2 * rounding) & hit
        flat = np.maximum(STEEP, 4 * np.sqrt(rounding / oracle.size(shape)))
        again &= (slope > flat) & (t * slope <= 8 * rounding)
        # Where the hit lies on a face on which the ray does not start, it is another crossing.
        again &= ~((np.abs(start.faces) > rounding) & (np.abs(at.faces) <= band + blur)).any(axis=0)
        if again.any():
            crossings = rays.crossings()
            own = np.nanargmin(np.where(np.isnan(crossings), np.inf, np.abs(crossings)), axis=0)[None]
            far = np.abs(np.take_along_axis(crossings, own, axis=0)) * steepest > rounding
            np.put_along_axis(crossings, own, np.where(far, np.take_along_axis(crossings, own, axis=0), np.nan), axis=0)
            good &= ~again | (np.abs(crossings - t) <= 0.1 * t).any(axis=0)
    return np.asarray(good)


class Wrong(NamedTuple):
    """A ray with a wrong answer."""

    shape: Shape
    origin: list[float]
    direction: list[float]
    t: float
    exact: float

    def __str__(self) -> str:
        return f"t = {self.t!r}, not {self.exact!r}: {line_of(self.shape)} from {self.origin} along {self.direction}"


def wrong(shape: Shape, origins: Array, directions: Array, t: Array, most: int = 4) -> list[Wrong]:
    """The wrong ones of answers t; of those that seem wrong only so many are judged in 60 digits."""
    seem = np.flatnonzero(~right(shape, origins, directions, t))[:most]
    if not len(seem):
        return []
    rays = origins[seem], directions[seem]
    surely = np.flatnonzero(~right(shape, *rays, t[seem], True))
    exact = Crossed(shape, *rays, True).nearest()
    return [Wrong(shape, *(part[i].tolist() for part in rays), float(t[seem][i]), float(exact[i])) for i in surely]


def certified(shape: Shape, origins: Array, directions: Array, t: Array) -> certificates.Certificate:
    """Certificates of answers t of n rays at one shape, NaN for misses; with the normals of the formulas."""
    hit = np.isfinite(t)
    found = surfaces([shape], (origins + np.where(hit, t, 0.0)[:, None] * directions)[None])[1][0]
    owners = np.where(hit, 0, -1)
    return certificates.certify((shape,), owners, 0 * owners, certificates.Rays(origins, directions, t, found))


def off(shape: Shape, origins: Array, directions: Array, t: Array) -> Array:
    """How far hits are from the surface by each face alone, in units of the certificate; NaN for misses."""
    there = Crossed(shape, origins, directions).heights(t)
    first = oracle.points(shape)[0]
    scale = U * (t + np.linalg.norm(origins - first, axis=1) + oracle.size(shape))
    with np.errstate(all="ignore"):
        above = np.abs(there.faces[0]) if oracle.is_sheet(shape) else np.abs(there.above)
        return np.asarray(np.fmax(above, there.beyond if oracle.is_sheet(shape) else 0.0) / scale)
