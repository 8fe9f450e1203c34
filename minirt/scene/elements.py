"""The elements of a scene that are neither shapes nor light sources: resolution, ambient light, camera, background."""

from __future__ import annotations

from dataclasses import field
from functools import partial

from minirt.element import Element
from minirt.fields import Choice, Colour, Direction, Length, Paint, Point, Real, Triple, Whole, declare, unit
from minirt.records import record

ENDS = "renders as the nearest angle that can be drawn"
FieldOfView = partial(Real, unit="degree", low=0.0, high=180.0, step=2.0, ends=ENDS)
Focus = partial(Length, initial=8.0)
TONES = ("plain", "srgb", "filmic")  # how light becomes the levels of a picture, see `minirt.rendering.tone_mapping`


@record()
class Resolution(Element):
    """`R width height`: size of the window and of pictures, in pixels."""

    code, title, plural, once = "R", "resolution", "resolutions", True
    width: int = declare(Whole, "width of the picture", unit="pixel", low=1, high=16384)
    height: int = declare(Whole, "height of the picture", unit="pixel", low=1, high=16384)


@record()
class Ambient(Element):
    """`A ratio R,G,B`: light that reaches every surface from everywhere."""

    code, title, plural, once, required = "A", "ambient light", "ambients", True, True
    brightness: float = declare(Real, "brightness", unit="ratio", low=0.0, high=1.0, step=0.05)
    colour: Triple = declare(Colour, "colour")


@record()
class Camera(Element):
    """`C x,y,z dx,dy,dz fov [roll:degrees] [tone:word] [exposure:EV] [lens:diameter] [focus:distance]`: a pinhole
    camera, or with `lens` a thin lens of that diameter.

    A lens shows what lies at the distance `focus` sharply, measured along the viewing direction; when that is left out,
    what the middle of the picture shows. Everything else is blurred.

    Light is multiplied by two to the power of `exposure`. With the `tone` plain the levels of colours and of the
    picture are in proportion to light. srgb decodes colours, and encodes light, by the curve of sRGB; filmic does the
    same, and compresses bright light before it encodes it.
    `left_handed` mirrors the picture, for scenes made for left-handed coordinates; it is not written to a file.
    """

    code, title, plural, once, required = "C", "camera", "cameras", True, True
    position: Triple = declare(Point, "position of the eye")
    direction: Triple = declare(Direction, "viewing direction", instead=(0.0, 0.0, 1.0), may_be_zero=True)
    fov: float = declare(FieldOfView, "horizontal field of view")
    roll: float = declare(
        Real, "turn about the direction, clockwise", unit="degree", low=-360.0, high=360.0, keyed=True, default=0.0
    )
    tone: str = declare(
        Choice, "how light becomes colour: plain, srgb or filmic", words=TONES, keyed=True, default=TONES[0]
    )
    exposure: float = declare(
        Real, "light times two to this power", unit="EV", low=-20.0, high=20.0, step=0.25, keyed=True, default=0.0
    )
    lens: float | None = declare(
        Length, "diameter of the lens; depth of field", keyed=True, default=None, placeholder="diameter", initial=0.2
    )
    focus: float | None = declare(
        Focus, "distance, along the direction, of what is sharp", keyed=True, default=None, placeholder="distance"
    )
    left_handed: bool = field(default=False, kw_only=True)

    @classmethod
    def look_at(cls, eye: Triple, target: Triple, *, fov: float = 60.0, roll: float = 0.0) -> Camera:
        """Return a camera at `eye` with `target` in the middle of its picture; ValueError when they are equal."""
        x, y, z = (there - here for here, there in zip(eye, target, strict=True))
        if not any((x, y, z)):
            raise ValueError("camera eye and target must be two different points")
        return cls(eye, unit((x, y, z)), fov, roll)


@record()
class Background(Element):
    """`bg R,G,B` or `bg file`: colour or environment map for rays that hit nothing; black without this line.

    The environment map is equirectangular (columns are equal angles of longitude, rows of latitude) and infinitely
    far away: its middle is seen along +z, its upper border along +y, and its right half is on the right of a camera
    that looks along +z.
    """

    code, title, plural, once = "bg", "background", "backgrounds", True
    paint: Triple | str = declare(Paint, "colour, or an environment map")


def linear_combination(a: float, u: Triple, b: float, v: Triple) -> Triple:
    """Return a u + b v."""
    return a * u[0] + b * v[0], a * u[1] + b * v[1], a * u[2] + b * v[2]
