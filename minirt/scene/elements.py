"""The elements of a scene that are not shapes: ambient light, camera, lights, window size."""

from __future__ import annotations

from dataclasses import dataclass

from minirt.element import Element
from minirt.fields import Colour, Direction, Point, Real, Triple, Whole, declare

WHITE = (255, 255, 255)


@dataclass(frozen=True)
class Resolution(Element):
    """`R width height`: the size of the window, in pixels."""

    code, title, plural, once = "R", "resolution", "resolutions", True
    width: int = declare(Whole, "width of the picture", unit="pixel", low=1, high=16384)
    height: int = declare(Whole, "height of the picture", unit="pixel", low=1, high=16384)


@dataclass(frozen=True)
class Ambient(Element):
    """`A ratio R,G,B`: light that reaches every surface from everywhere."""

    code, title, plural, once, required = "A", "ambient light", "ambients", True, True
    brightness: float = declare(Real, "brightness", unit="ratio", low=0.0, high=1.0, step=0.05)
    colour: Triple = declare(Colour, "colour")


@dataclass(frozen=True)
class Camera(Element):
    """`C x,y,z dx,dy,dz fov [roll:degrees]`: the eye."""

    code, title, plural, once, required = "C", "camera", "cameras", True, True
    position: Triple = declare(Point, "the eye")
    direction: Triple = declare(Direction, "where it looks", instead=(0.0, 0.0, 1.0))
    fov: float = declare(
        Real,
        "horizontal field of view",
        unit="degree",
        low=0.0,
        high=180.0,
        step=2.0,
        ends="renders as the nearest angle that can be drawn",
    )
    roll: float = declare(
        Real, "turn about the direction, clockwise", unit="degree", low=-360.0, high=360.0, keyed=True, default=0.0
    )


@dataclass(frozen=True)
class Light(Element):
    """`L x,y,z ratio [R,G,B]`: the point light of the mandatory format."""

    code, title, plural, once = "L", "light", "lights", True
    position: Triple = declare(Point, "where it stands")
    brightness: float = declare(Real, "brightness", unit="ratio", low=0.0, high=1.0, step=0.05)
    colour: Triple = declare(Colour, "colour", default=WHITE)


@dataclass(frozen=True)
class FurtherLight(Light):
    """`l x,y,z ratio [R,G,B]`: any number of further point lights."""

    code, title, plural, once = "l", "further light", "further_lights", False
