"""Table of regimes: sets of rays that are easy or hard for an intersection formula."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import NamedTuple

from minirt.element import fields_of
from minirt.shapes import Kind
from tests.oracle import random_rays
from tests.oracle.random_rays import Random, Rays, Scale


class Regime(NamedTuple):
    """A set of rays that is hard in one way; `pose(kind, random, shapes, rays per shape)` makes the rays."""

    name: str
    about: str
    pose: Callable[[Kind, Random, int, int], Rays]
    needs: frozenset[str] = frozenset()  # fields that a shape must have
    lacks: frozenset[str] = frozenset()  # fields that a shape must not have


def regime(
    name: str,
    about: str,
    pose: Callable[..., Rays],
    needs: Iterable[str] = (),
    lacks: Iterable[str] = (),
    **how: object,
) -> Regime:
    """Make a row of the table."""
    return Regime(name, about, partial(pose, **{"scale": Scale(), **how}), frozenset(needs), frozenset(lacks))


FLAT = ("normal",)
ROUND, UPRIGHT, LONG = ("diameter",), ("axis", "diameter"), ("axis", "diameter", "height")
REGIMES = (
    regime("benign", "3 to 20 sizes away", random_rays.rays_towards, away=(3, 20)),
    regime("far", "100 to 1e6 sizes away", random_rays.rays_towards, away=(1e2, 1e6)),
    regime(
        "tiny and far", "1e-6 across, 1e5 to 1e6 away", random_rays.rays_towards, scale=Scale(1e-6), away=(1e11, 1e12)
    ),
    regime("offset", "1e8 from the scene's origin", random_rays.rays_towards, scale=Scale(offset=1e8), away=(3, 20)),
    regime("inside", "from within", random_rays.rays_from_inside, ROUND),
    regime("tangent", "1e-16 to 1e-4 off the surface", random_rays.tangent_rays, ROUND, FLAT, off=(1e-16, 1e-4)),
    regime("grazing", "slope 1e-15 to 1e-6", random_rays.grazing_rays, FLAT, slope=(1e-15, 1e-6)),
    regime(
        "just above",
        "1e-6 to 1 above one 1e9 across",
        random_rays.rays_from_above,
        ROUND,
        scale=Scale(1e9),
        height=(1e-6, 1.0),
    ),
    regime("rim", "1e-16 to 1e-6 beside it", random_rays.rays_at_rims, LONG, off=(1e-16, 1e-6)),
    regime("along the axis", "1e-12 to 1e-3 off it", random_rays.axial_rays, UPRIGHT, angle=(1e-12, 1e-3), back=5.0),
    regime(
        "long tube",
        "inside, height 1e9, 1e-8 to 1e-2 off the axis",
        random_rays.axial_rays,
        LONG,
        scale=Scale(lengths=(("height", 1e9),)),
        angle=(1e-8, 1e-2),
    ),
    regime(
        "thin disc",
        "height 1e-9",
        random_rays.rays_towards,
        LONG,
        scale=Scale(lengths=(("height", 1e-9),)),
        away=(3, 20),
    ),
)


def regimes_of(kind: Kind) -> list[Regime]:
    """Return the regimes that apply to a shape type."""
    names = {each.name for each in fields_of(kind.element)}
    return [each for each in REGIMES if each.needs <= names and not each.lacks & names]
