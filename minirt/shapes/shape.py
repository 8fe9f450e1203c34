"""What every shape's file provides, and what its formulas mean.

A file of a shape holds its manual page, its line in a scene file (a frozen dataclass), what the kernel keeps of it
(a NamedTuple of numbers and Vecs, made by `pack`) and three formulas:

    intersect(shape, origin, direction)   the distance t along the unit `direction` at which the ray enters or, from
                                          inside, leaves the shape: the least t > 0, or infinity
    surface(shape, point)                 a point within rounding of the surface: that point put onto the surface, and
                                          the unit normal there, outward where there is an outside
    mapping(shape, point, normal)         where a picture has this point of the surface with this normal: u to the right
                                          and v upwards, 0 to 1 across a picture; and the tangents dP/du and dP/dv
    shading(shape, point, normal)         of the few that stand for something rounder: the unit normal by which such a
                                          point is lit, where `normal` is that of the surface
    may_meet(shape, apex, start, direction, asked)
                                          of those that are many: which rays of a packet through a common point, the
                                          apex, may meet the shape; see `minirt.shapes.pyramid`

The tangents and the normal are right-handed, so that nobody outside sees a picture mirrored. At poles and apexes, where
a picture is gathered to a point, tangents may be zero.

A mesh is many triangles, each of which the kernel keeps for itself: such a shape has `parts`.
"""

from __future__ import annotations

import sys
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, NewType, get_type_hints

import numpy as np

from minirt.fields import Triple
from minirt.lanes import Vec
from minirt.lanes.operations import Mask
from minirt.materials import Attributes

Bounds = tuple[Triple, Triple]  # least and greatest corner
Ball = tuple[Triple, float]  # centre and radius
Position = NewType("Position", Vec)  # in a packed shape: a point, where other Vecs are directions


@dataclass(frozen=True, kw_only=True)
class Shape(Attributes):
    """A surface that rays can hit; the last field of every shape is its colour, and all have these attributes."""

    batched: ClassVar[bool] = False  # whether one element is many primitives, as a mesh is many triangles
    if TYPE_CHECKING:
        colour: Triple

    @property
    def parts(self) -> int:
        """How many things the kernel keeps of it."""
        return 1

    def some(self, parts: np.ndarray) -> Shape:
        """The shape that is some of its parts."""
        return self

    @abstractmethod
    def pack(self) -> Any:
        """What the kernel keeps of the shape: the NamedTuple of its `Kind`."""

    @abstractmethod
    def balls(self) -> tuple[Ball, ...]:
        """Balls around whose convex hull nothing of the shape sticks out, as many for each shape of a kind; none where
        the shape has no end."""

    def flat(self) -> tuple[Triple, Triple] | None:
        """A point and the unit normal of a shape that is a whole plane; None for all others. The kind decides which."""
        return None

    @abstractmethod
    def bounds(self) -> Bounds | None:
        """The axis-aligned box around the shape, or None where it has no end."""


def geometric_normal(shape: Any, point: Vec, normal: Vec) -> Vec:
    """`shading` of a shape that is what it looks like."""
    return normal


def all_rays(shape: Any, apex: Vec, start: Vec | None, direction: Vec, active: Mask) -> Mask:
    """`may_meet` of a shape that is tested as fast."""
    return active


class Kind(NamedTuple):
    """One entry of the registry of shapes."""

    element: type[Shape]
    packed: type[Any]
    intersect: Callable[..., Any]
    surface: Callable[..., Any]
    mapping: Callable[..., Any]
    shading: Callable[..., Any] = geometric_normal
    may_meet: Callable[..., Any] = all_rays
    batched: bool = False  # whether one element is many small ones side by side


def kind_of(element: type[Shape]) -> Kind:
    """Make the entry of the registry for a shape from the names in its file; AttributeError where one is missing."""
    module = sys.modules[element.__module__]
    optional = {name: getattr(module, name) for name in ("shading", "may_meet") if hasattr(module, name)}
    packed = get_type_hints(element.pack)["return"]
    return Kind(element, packed, module.intersect, module.surface, module.mapping, **optional, batched=element.batched)
