"""Shapes with an axis or a normal, and a turn about it."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, ClassVar

from minirt.fields import Angle, Direction, Triple, declare
from minirt.lanes import Vec
from minirt.records import record
from minirt.shapes.basis import basis, facing_frame
from minirt.shapes.shape import Shape

Frame = tuple[Vec, Vec, Vec]  # right-handed and orthonormal; the last vector is the axis or the normal
UPRIGHT: Triple = (0.0, 1.0, 0.0)
ROLL = "turn about its axis or normal, counter-clockwise as seen from its tip"


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
