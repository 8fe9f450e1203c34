"""What every shape's file provides, and what its formulas mean.

A file of a shape holds its manual page, its line in a scene file (a frozen dataclass), what the kernel keeps of it
(a NamedTuple of numbers and Vecs, made by `pack`) and two formulas:

    intersect(shape, origin, direction)   the distance t along the unit `direction` at which the ray enters or, from
                                          inside, leaves the shape: the least t > 0, or infinity
    surface(shape, point)                 a point within rounding of the surface: that point put onto the surface, and
                                          the unit normal there, outward where there is an outside
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, NewType

from minirt.element import Element
from minirt.fields import Triple
from minirt.lanes import Vec

Box = tuple[Triple, Triple]  # least and greatest corner
Ball = tuple[Triple, float]  # centre and radius
Place = NewType("Place", Vec)  # in a packed shape: a point, where other Vecs are directions


@dataclass(frozen=True)
class Shape(Element):
    """A surface that rays can hit; the last field of every shape is its colour."""

    if TYPE_CHECKING:
        colour: Triple

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
    def bounds(self) -> Box | None:
        """The axis-aligned box around the shape, or None where it has no end."""


class Kind(NamedTuple):
    """One entry of the registry of shapes."""

    element: type[Shape]
    packed: type[Any]
    intersect: Callable[..., Any]
    surface: Callable[..., Any]
