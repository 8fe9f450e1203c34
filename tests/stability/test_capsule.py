"""A made-up shape whose boundary is a union: a capsule, stated in two lines and tested as any kind is."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Number, Vec, dot, maximum, minimum, sqrt, where
from minirt.records import record
from minirt.shapes import KINDS, cylinder, sphere
from minirt.shapes.boundary import Boundary, clamp, length
from minirt.shapes.frames import in_scene, own_point
from minirt.shapes.shape import Axial, Ball, Hit, Kind, Position, point_along
from tests import oracle
from tests.seeds import RUN
from tests.shapes import execution_modes
from tests.shapes.execution_modes import on_arrays
from tests.shapes.regimes import GREY
from tests.stability.rays import Pose
from tests.stability.test_exact import complaints


@record()
class Capsule(Axial):
    """A cylinder with half a ball at each end."""

    code, title, plural, revolved = "ca", "capsule", "capsules", True
    centre: Triple = declare(Point, "centre")
    axis: Triple = declare(Direction, "axis")
    diameter: float = declare(Length, "diameter")
    height: float = declare(Length, "height of the cylinder")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedCapsule:
        return PackedCapsule(Position(Vec(*self.centre)), *self.frame(), self.diameter / 2, self.height / 2)

    def balls(self) -> tuple[Ball, ...]:
        ends = (point_along(self.centre, self.axis, up) for up in (-self.height / 2, self.height / 2))
        return tuple((end, self.diameter / 2) for end in ends)


class PackedCapsule(NamedTuple):
    """Packed form of a capsule."""

    centre: Position
    u: Vec
    v: Vec
    w: Vec
    radius: float
    half: float


def intersect(
    capsule: PackedCapsule, origin: Vec, direction: Vec, limit: Number | None = None, union: Any = None
) -> Hit:
    """Whether and where a ray from outside meets the capsule: the nearest hit of its three parts."""
    ends = (
        sphere.PackedSphere(capsule.centre + side * capsule.half * capsule.w, capsule.radius) for side in (-1.0, 1.0)
    )
    hits = [cylinder.intersect(cylinder.PackedCylinder(*capsule), origin, direction, limit)]
    hits += [sphere.intersect(end, origin, direction, limit) for end in ends]
    t = (union or minimum)(*(where(hit, at, float("inf")) for hit, at in hits[:2]))
    t = minimum(t, where(*hits[2], float("inf")))
    return t < float("inf"), t


def surface(capsule: PackedCapsule, point: Vec) -> tuple[Vec, Vec]:
    """The point of the capsule nearest to `point`, and the outward normal there."""
    p = own_point(capsule, point)
    middle = Vec(0.0 * p.x, 0.0 * p.y, minimum(maximum(p.z, -capsule.half), capsule.half))
    out = p - middle
    out = out / sqrt(dot(out, out))
    return in_scene(capsule, middle + capsule.radius * out, out)


def boundary(capsule: Any, point: Vec) -> Boundary:
    """Distance from the segment in the middle, less the radius."""
    p = point - capsule.centre
    height = clamp(dot(capsule.axis, p), -0.5 * capsule.height, 0.5 * capsule.height)
    return Boundary((length(p - height * capsule.axis) - 0.5 * capsule.diameter,))


CAPSULE = Kind(Capsule, PackedCapsule, intersect, surface, cylinder.mapping, boundary)
OUTSIDE = Pose((1e-3, 1e3), (1.0, 1.0), (0.1, 10.0))  # the ends of its formula are rounded like its coordinates


@pytest.fixture(autouse=True)
def _registered(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (oracle, execution_modes):
        monkeypatch.setattr(module, "KINDS", [*KINDS, CAPSULE])


def test_hits_known_by_hand() -> None:
    capsule = Capsule((0, 0, 5), (0, 1, 0), 2, 4, GREY)
    assert oracle.nearest(capsule, (0, 0, 0), (0, 0, 1)) == 4
    assert oracle.nearest(capsule, (0, 9, 5), (0, -1, 0)) == 6
    assert oracle.nearest(capsule, (0.6, 9, 5), (0, -1, 0)) == pytest.approx(6.2, rel=1e-15)
    assert oracle.nearest(capsule, (0, 0, 5), (0, 1, 0)) == 3
    assert oracle.nearest(capsule, (1.01, 9, 5), (0, -1, 0)) == float("inf")


def from_outside(shapes: Any, origins: Any, directions: Any, formula: Any = None) -> Any:
    """Answers of the formula from outside. From inside and from the surface parts of a union do not know the others:
    there the answers are the oracle's, but for hits where the rays start."""
    t = on_arrays(shapes, origins, directions, formula)
    rays = oracle.Crossed(shapes[0], origins[0], directions[0])
    rounding = 1e-14 * (np.abs(origins[0]).max(axis=1) + oracle.size(shapes[0]))
    inside = rays.heights(0.0 * rays.approach).above < rounding
    crossings = rays.crossings()
    later = np.where(crossings > 100 * rounding, crossings, np.inf).min(axis=0, initial=np.inf)
    t[0, inside] = later[inside]
    return t


def test_answers_are_exact() -> None:
    assert not complaints(CAPSULE, from_outside, drawn=OUTSIDE), RUN


def test_a_capsule_without_one_of_its_ends_is_found() -> None:
    def without(shapes: Any, origins: Any, directions: Any) -> Any:
        def wrong(*given: Any) -> Hit:
            return intersect(*given, union=lambda side, end: side)

        return from_outside(shapes, origins, directions, wrong)

    assert complaints(CAPSULE, without, drawn=OUTSIDE), RUN
