"""The interface of shapes: what each shape's file defines.

The file of a shape holds its manual page, its line in a scene file (a record), its packed form for the kernel
(a NamedTuple of numbers and Vecs, made by `pack`), three functions on packed shapes:

    intersect(shape, origin, direction, limit)
                                          whether a ray hits the shape, and the distance t along the unit `direction` at
                                          which it enters or, from inside, leaves: the least t > 0; `limit` is None,
                                          or where shadow rays end, which start clear of all surfaces: then only whether
                                          t < `limit` counts
    surface(shape, point)                 `point`, which is within rounding of the surface, moved onto it, and the unit
                                          normal there, outward where there is an outside
    mapping(shape, point, normal)         texture coordinates of a point of the surface with this normal: u to the right
                                          and v upwards, 0 to 1 across a picture; and the tangents dP/du and dP/dv

and one on the fields of the scene line, which states the shape once more, for the certificates of hits:

    boundary(shape, point)                its faces: functions of a point that are 0 on a face and grow outwards, see
                                          `minirt.shapes.boundary`

Three functions are optional:

    shading(shape, point, normal)         the unit normal by which the point is lit, where that is not the `normal` of
                                          the surface: smooth shading of meshes
    smooth_point(shape, point, normal)    the point of a smooth surface above a point of its facet, on the side of
                                          `normal`; shadow rays of `smooth` shapes start there
    may_meet(shape, apex, start, direction, active)
                                          culling: which of the active rays of a packet with a common point, the apex,
                                          may hit the shape, see `minirt.shapes.triangle`

The tangents and the normal are right-handed, so that a picture seen from outside is not mirrored. At poles and apexes,
where a picture shrinks to a point, tangents may be zero.

A mesh is many triangles, each packed by itself: such a shape has several `parts`.
"""

from __future__ import annotations

import sys
from abc import abstractmethod
from collections.abc import Callable
from math import hypot
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, NewType, get_type_hints

import numpy as np

from minirt.fields import Angle, Direction, Triple, declare
from minirt.lanes import Mask, Number, Vec
from minirt.materials import Attributes
from minirt.records import record
from minirt.shapes.boundary import Boundary
from minirt.shapes.frames import basis, facing_frame

Bounds = tuple[Triple, Triple]  # axis-aligned bounding box: least and greatest corner
Ball = tuple[Triple, float]  # centre and radius
Hit = tuple[Mask, Number]  # whether a ray hits a shape, and where
Frame = tuple[Vec, Vec, Vec]  # right-handed and orthonormal; the last vector is the axis or the normal
UPRIGHT: Triple = (0.0, 1.0, 0.0)
ROLL = "turn about its axis or normal, counter-clockwise as seen from its tip"
Position = NewType("Position", Vec)  # a point in a packed shape; other Vecs there are directions


@record(kw_only=True)
class Shape(Attributes):
    """A surface that rays can hit, with its materials. The last field of every shape is its colour."""

    batched: ClassVar[bool] = False  # whether one element is many primitives, as a mesh is many triangles
    columnar: ClassVar[bool] = False  # whether `pack`, `balls` and `bounds` take fields that are columns of many shapes
    infinite: ClassVar[bool] = False  # whether the shapes of this kind have no bounding box, as planes
    solid: ClassVar[bool] = True  # whether it has an inside, that of a plane being below it
    convex: ClassVar[bool] = False  # whether a ray that leaves it never meets it again, by more than rounding
    parts: ClassVar[int] = 1  # primitives in the kernel; a mesh has more
    smooth: ClassVar[bool] = False  # whether its flat parts are shaded as if they were curved; a mesh may be
    if TYPE_CHECKING:  # its kinds declare it as a field

        @property
        def colour(self) -> Triple: ...

    def some(self, parts: np.ndarray) -> Shape:
        """The shape made of some of its parts, by their indices."""
        return self

    @abstractmethod
    def pack(self) -> Any:
        """Convert the shape to its packed form for the kernel: the NamedTuple of its `Kind`."""

    def map_frame(self) -> tuple[Vec, Vec, Vec] | None:
        """The frame in which `mapping` computes where it takes the directions z, x and y of the scene for the shape's
        own; None where the packed form says how the shape is turned."""
        return None

    @abstractmethod
    def balls(self) -> tuple[Ball, ...]:
        """Bounding balls: the shape lies in their convex hull. All shapes of a kind have as many; an infinite one has
        none."""

    def infinite_plane(self) -> tuple[Triple, Triple] | None:
        """A point and the unit normal of an infinite plane; None for all other kinds."""
        return None

    def bounds(self) -> Bounds | None:
        """The axis-aligned bounding box, here that of the centres of its balls; None for a kind that is `infinite`."""
        return bounds_of_points(*(centre for centre, _ in self.balls()))


def geometric_normal(shape: Any, point: Vec, normal: Vec) -> Vec:
    """`shading` of a shape without smooth shading: the normal of its surface."""
    return normal


def same_point(shape: Any, point: Vec, normal: Vec) -> Vec:
    """`smooth_point` of a shape without facets: the point itself."""
    return point


def all_rays(shape: Any, apex: Vec, start: Vec | None, direction: Vec, active: Mask) -> Mask:
    """`may_meet` of a shape without culling, whose `intersect` is as fast as a test: all active rays."""
    return active


class Kind(NamedTuple):
    """One entry of the registry of shapes."""

    element: type[Shape]
    packed: type[Any]
    intersect: Callable[..., Any]
    surface: Callable[..., Any]
    mapping: Callable[..., Any]
    boundary: Callable[..., Boundary]
    shading: Callable[..., Any] = geometric_normal
    smooth_point: Callable[..., Any] = same_point
    may_meet: Callable[..., Any] = all_rays


def kind_of(element: type[Shape]) -> Kind:
    """Make the entry of the registry for a shape from the names in its file; TypeError where one is missing."""
    formulas = {name: found for name, found in vars(sys.modules[element.__module__]).items() if name in Kind._fields}
    packed = get_type_hints(element.pack)["return"]
    return Kind(element, packed, **formulas)


def point_along(point: Triple, axis: Triple, distance: float) -> Triple:
    """The point at a distance from `point` along the unit vector `axis`."""
    (x, y, z), (u, v, w) = point, axis
    return x + distance * u, y + distance * v, z + distance * w


def bounds_of_disc(centre: Triple, axis: Triple, radius: float) -> Bounds:
    """The bounding box of a disc about a unit axis.

    For a component w of the axis it reaches radius * sqrt(1 - w^2), here by the sum of the other two squares.
    """
    (x, y, z), (u, v, w) = centre, axis
    i, j, k = radius * hypot(v, w), radius * hypot(w, u), radius * hypot(u, v)
    return (x - i, y - j, z - k), (x + i, y + j, z + k)


def bounds_of_points(*points: Triple) -> Bounds:
    """The bounding box of some points."""
    xs, ys, zs = zip(*points, strict=True)
    return (min(xs), min(ys), min(zs)), (max(xs), max(ys), max(zs))


def union_of_bounds(*boxes: Bounds) -> Bounds:
    """The bounding box of some boxes."""
    return bounds_of_points(*(corner for box in boxes for corner in box))


@record(kw_only=True)
class Oriented(Shape):
    """A shape that can be turned about an axis or a normal of its own."""

    revolved: ClassVar[bool] = False  # whether it looks the same after such a turn if nothing lies on it
    roll: float = declare(
        Angle, ROLL, placeholder="degrees", keyed=True, default=0.0, sort="shapes with an axis or a normal"
    )

    @abstractmethod
    def frame(self) -> Frame:
        """Its own frame, which turns with it."""

    @property
    def shows_axis(self) -> bool:
        """Whether another axis or normal changes the picture."""
        return True

    @property
    def shows_roll(self) -> bool:
        """Whether a turn about its axis or normal changes the picture."""
        return not self.revolved or self.is_mapped


@record(kw_only=True)
class Axial(Oriented):
    """A shape with an axis; its own frame is z, x and y, where y is the axis."""

    if TYPE_CHECKING:

        @property
        def axis(self) -> Triple: ...

    def frame(self) -> Frame:
        return basis(self.axis, self.roll)


@record(kw_only=True)
class Capped(Axial):
    """A solid of revolution in the hull of two discs, which are the middle sections of its balls."""

    def bounds(self) -> Bounds:
        return union_of_bounds(*(bounds_of_disc(centre, self.axis, radius) for centre, radius in self.balls()))


@record(kw_only=True)
class Flat(Oriented):
    """A flat shape; its own frame is right and up of a picture on it, and the normal."""

    if TYPE_CHECKING:

        @property
        def normal(self) -> Triple: ...

    def frame(self) -> Frame:
        return *facing_frame(self.normal, self.roll), Vec(*self.normal)


@record(kw_only=True)
class Turnable(Axial):
    """A shape that stands upright unless it is given an axis."""

    axis: Triple = declare(
        Direction, "direction of its own y axis", keyed=True, default=UPRIGHT, sort="spheres and meshes"
    )

    @property
    def is_turned(self) -> bool:
        """Whether its own axes are not those of the scene."""
        return self.axis != UPRIGHT or self.roll % 360.0 != 0.0
