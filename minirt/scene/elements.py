"""The elements of a scene that are no shapes: resolution, ambient light, camera, background and light sources.

A light source gives a surface its colour times its brightness times the cosine of the angle of incidence (Lambert).
"""

from __future__ import annotations

from dataclasses import field
from functools import partial
from math import cos, radians
from typing import Any

from minirt.element import Element
from minirt.fields import Choice, Colour, Direction, Length, Paint, Point, Real, Triple, Whole, declare, unit
from minirt.records import record

DEFAULT_SIZE = (1280, 720)  # pixels, for a scene that does not name a size
ENDS = "renders as the nearest angle that can be drawn"
FieldOfView = partial(Real, unit="degree", low=0.0, high=180.0, step=2.0, ends=ENDS)
Focus = partial(Length, initial=8.0)
TONES = ("plain", "srgb", "filmic")  # how light becomes the levels of a picture, see `minirt.rendering.tone_mapping`
RATIO: dict[str, Any] = {"unit": "ratio", "low": 0.0, "high": 1.0, "step": 0.05}
AngularDiameter = partial(Real, unit="degree", low=0.0, high=90.0, step=0.25, initial=2.0)
WHITE = (255, 255, 255)
DOWN = (0.0, -1.0, 0.0)
REACH: dict[str, Any] = {"key": "reach", "keyed": True, "placeholder": "distance", "initial": 16.0}
FADE = "distance at which its light has faded to nothing"
SIZE = "diameter; soft shadows"
ALL_DIRECTIONS = (0.0, 0.0, 0.0, -2.0, 1.0)  # the cone of a light that shines in all directions
STEEPEST = 1e30  # the steepness of a spot whose rim has no width


@record()
class Resolution(Element):
    """`R width height`: size of the window and of pictures, in pixels."""

    code, title, plural, once = "R", "resolution", "resolutions", True
    width: int = declare(Whole, "width of the picture", unit="pixel", low=1, high=16384, initial=DEFAULT_SIZE[0])
    height: int = declare(Whole, "height of the picture", unit="pixel", low=1, high=16384, initial=DEFAULT_SIZE[1])


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
        Focus,
        "distance, along the direction, of what is sharp",
        keyed=True,
        default=None,
        placeholder="distance",
        needs=("lens",),
    )
    left_handed: bool = field(default=False, kw_only=True)
    # Names and values of the fields that the window's user gave a value: see `minirt.viewer.editing.state`.
    edited: tuple[tuple[str, object], ...] = field(default=(), kw_only=True, compare=False, repr=False)

    @classmethod
    def look_at(cls, eye: Triple, target: Triple, *, fov: float = 60.0, roll: float = 0.0) -> Camera:
        """Return a camera at `eye` with `target` in the middle of its picture; ValueError when they are equal."""
        x, y, z = (there - here for here, there in zip(eye, target, strict=True))
        if not any((x, y, z)):
            raise ValueError("camera eye and target must be two different points")
        return cls(eye, unit((x, y, z)), fov, roll)


@record()
class FurtherCamera(Camera):
    """`c x,y,z dx,dy,dz fov ...`: any number of further cameras, with the attributes of the first.

    `Scene.seen_by` chooses the one that pictures show.
    """

    code, title, plural, once, required = "c", "further camera", "further_cameras", False, False


@record()
class Background(Element):
    """`bg R,G,B` or `bg file`: colour or environment map for rays that hit nothing; black without this line.

    The environment map is equirectangular (columns are equal angles of longitude, rows of latitude) and infinitely
    far away: its middle is seen along +z, its upper border along +y, and its right half is on the right of a camera
    that looks along +z.
    """

    code, title, plural, once = "bg", "background", "backgrounds", True
    paint: Triple | str = declare(Paint, "colour, or an environment map")


class Lamp(Element):
    """Base class of light sources: each has a brightness and a colour."""

    brightness: float
    colour: Triple
    position: Triple | None = None  # None: it shines from infinitely far away
    fade: float | None = None
    size: float | None = None

    # What the kernel reads of it: see `minirt.kernel.shading.lights`.

    def cone(self) -> tuple[float, ...]:
        """Axis, cosine at the edge of the cone, and steepness: 1 / (cosine at full intensity - cosine at the edge)."""
        return ALL_DIRECTIONS

    def fading(self) -> float:
        """One over the distance at which it has faded to nothing; 0 if it does not."""
        return 1 / self.fade if self.fade else 0.0

    def features(self) -> tuple[str, ...]:
        """The features of the kernel that it needs: see `minirt.rendering.packing.features`."""
        is_spot = self.cone() != ALL_DIRECTIONS or self.fading() > 0.0
        needs = {"spots": is_spot, "parallel": not self.position, "soft": bool(self.size)}
        return tuple(name for name, needed in needs.items() if needed)


@record()
class Light(Lamp):
    """`L x,y,z ratio [R,G,B]`: the point light of the mandatory format.

    With `reach` its light is multiplied by 1 - distance/reach, and by 0 beyond that distance. With `size` it is a ball
    of that diameter, which shines as a disc that faces each point: shadows are soft.
    """

    code, title, plural, once = "L", "light", "lights", True
    position: Triple = declare(Point, "position of the light")
    brightness: float = declare(Real, "brightness", shared=RATIO)
    colour: Triple = declare(Colour, "colour", default=WHITE)
    fade: float | None = declare(Length, FADE, default=None, shared=REACH)
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
    `reach` and `size` are as for a point light; cone and fading are those of its centre.
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
    fade: float | None = declare(Length, FADE, default=None, shared=REACH)
    size: float | None = declare(Length, SIZE, keyed=True, default=None, placeholder="diameter", initial=1.0)

    def cone(self) -> tuple[float, ...]:
        half = radians(self.angle) / 2
        end, full = cos(half), cos(half * (1 - self.rim))
        return (*self.direction, end, 1 / (full - end) if full - end > 1 / STEEPEST else STEEPEST)


FURTHER: dict[type[Element], type[Element]] = {Light: FurtherLight, Camera: FurtherCamera}  # repeatable kinds
LAMPS = (Light, FurtherLight, ParallelLight, SpotLight)
PUBLIC = {kind.__name__: kind for kind in (Resolution, Ambient, Camera, FurtherCamera, Background, Lamp, *LAMPS)}


def multiple(a: float, u: Triple) -> Triple:
    """Return a u, without negative zeros."""
    return a * u[0] + 0.0, a * u[1] + 0.0, a * u[2] + 0.0


def linear_combination(a: float, u: Triple, b: float, v: Triple) -> Triple:
    """Return a u + b v."""
    return a * u[0] + b * v[0], a * u[1] + b * v[1], a * u[2] + b * v[2]
