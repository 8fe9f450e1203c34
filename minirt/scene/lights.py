"""Light sources: point, parallel and spot lights. `Scene.lights` are these, in the order of the file.

A light source gives a surface its colour times its brightness times the cosine of the angle of incidence (Lambert).
"""

from __future__ import annotations

from functools import partial
from math import cos, radians
from typing import Any

from minirt.element import Element
from minirt.fields import Colour, Direction, Length, Point, Real, Triple, declare
from minirt.records import record

RATIO: dict[str, Any] = {"unit": "ratio", "low": 0.0, "high": 1.0, "step": 0.05}
AngularDiameter = partial(Real, unit="degree", low=0.0, high=90.0, step=0.25, initial=2.0)
WHITE = (255, 255, 255)
DOWN = (0.0, -1.0, 0.0)
FADE = "distance at which its light has faded to nothing"
SIZE = "diameter; soft shadows"
ALL_DIRECTIONS = (0.0, 0.0, 0.0, -2.0, 1.0)  # the cone of a light that shines in all directions
STEEPEST = 1e30  # the steepness of a spot whose rim has no width


class Lamp(Element):
    """Base class of light sources: each has a brightness and a colour."""

    brightness: float
    colour: Triple
    fade: float | None = None
    size: float | None = None

    # What the kernel reads of it: see `minirt.kernel.shading.lights`.

    @property
    def place(self) -> Triple | None:
        """The place that it shines from; None for a light from infinitely far away."""
        return getattr(self, "position", None)

    def cone(self) -> tuple[float, ...]:
        """Axis, cosine at the edge of the cone, and steepness: 1 / (cosine at full intensity - cosine at the edge)."""
        return ALL_DIRECTIONS

    def fading(self) -> float:
        """One over the distance at which it has faded to nothing; 0 if it does not."""
        return 1 / self.fade if self.fade else 0.0

    def features(self) -> tuple[str, ...]:
        """The features of the kernel that it needs: see `minirt.rendering.packing.features`."""
        needs = {
            "spots": self.cone() != ALL_DIRECTIONS or self.fading() > 0.0,
            "parallel": not self.place,
            "soft": bool(self.size),
        }
        return tuple(name for name, needed in needs.items() if needed)


@record()
class Light(Lamp):
    """`L x,y,z ratio [R,G,B]`: the point light of the mandatory format.

    With `fade` its light is multiplied by 1 - distance/fade, and by 0 beyond that distance. With `size` it is a ball of
    that diameter, which shines as a disc that faces each point: shadows are soft.
    """

    code, title, plural, once = "L", "light", "lights", True
    position: Triple = declare(Point, "position of the light")
    brightness: float = declare(Real, "brightness", shared=RATIO)
    colour: Triple = declare(Colour, "colour", default=WHITE)
    fade: float | None = declare(Length, FADE, keyed=True, default=None, placeholder="distance", initial=16.0)
    size: float | None = declare(Length, SIZE, keyed=True, default=None, placeholder="diameter", initial=1.0)


@record()
class FurtherLight(Light):
    """`l x,y,z ratio [R,G,B]`: any number of further point lights."""

    code, title, plural, once = "l", "further light", "further_lights", False


@record()
class ParallelLight(Lamp):
    """`dl dx,dy,dz ratio [R,G,B]`: light along dx,dy,dz from an infinitely distant source, such as the sun.

    With `size` the source is a disc in the sky of that angular diameter; the sun's is 0.53 degrees.
    """

    code, title, plural = "dl", "parallel light", "parallel_lights"
    direction: Triple = declare(Direction, "direction of its light", instead=DOWN)
    brightness: float = declare(Real, "brightness", shared=RATIO)
    colour: Triple = declare(Colour, "colour", default=WHITE)
    size: float | None = declare(
        AngularDiameter, "angular diameter; soft shadows", keyed=True, default=None, placeholder="degrees"
    )

    def cone(self) -> tuple[float, ...]:
        return (*self.direction, -2.0, 1.0)


@record()
class SpotLight(Lamp):
    """`sl x,y,z dx,dy,dz angle ratio [R,G,B]`: light within a cone.

    `angle` is the full opening angle. `rim` is the outer share of the half-angle, a tenth when left out, in which the
    light grows from 0 to 1 as 3 t^2 - 2 t^3, with t from 0 to 1 linear in the cosine; a rim of 0 gives a sharp edge.
    `fade` and `size` are as for a point light; cone and fading are those of its centre.
    """

    code, title, plural = "sl", "spot light", "spot_lights"
    position: Triple = declare(Point, "position of the light")
    direction: Triple = declare(Direction, "direction of its light", instead=DOWN)
    angle: float = declare(Real, "full opening angle", unit="degree", low=0.0, high=180.0, step=2.0)
    brightness: float = declare(Real, "brightness", shared=RATIO)
    colour: Triple = declare(Colour, "colour", default=WHITE)
    rim: float = declare(
        Real, "outer share of the half-angle in which light fades", keyed=True, default=0.1, shared=RATIO
    )
    fade: float | None = declare(Length, FADE, keyed=True, default=None, placeholder="distance", initial=16.0)
    size: float | None = declare(Length, SIZE, keyed=True, default=None, placeholder="diameter", initial=1.0)

    def cone(self) -> tuple[float, ...]:
        half = radians(self.angle) / 2
        end, full = cos(half), cos(half * (1 - self.rim))
        return (*self.direction, end, 1 / (full - end) if full - end > 1 / STEEPEST else STEEPEST)


LAMPS = (Light, FurtherLight, ParallelLight, SpotLight)
PUBLIC = {kind.__name__: kind for kind in LAMPS}
