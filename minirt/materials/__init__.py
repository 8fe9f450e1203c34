"""The registry of materials: highlights and glow, and the fields by which every shape may have a material.

Another material is a class with its manual page and its rows in the arrays of the kernel, and a field of `Attributes`.
Parser, writer, editor, documentation, the public name `minirt.Glass`, the features of the kernel, packing, reports and
the measurement of what a feature costs derive from that. What is left to write is how it changes light, where no
feature of the kernel does that yet (`minirt.kernel.shading`, `minirt.rendering.packing.features`).
"""

from __future__ import annotations

from functools import partial
from typing import Any, ClassVar

from minirt.element import Element, fields_of
from minirt.fields import Factor, Flag, Real, Triple, declare
from minirt.materials.compound import Compound, Material, Share
from minirt.materials.glass import Fresnel, Glass, Mirror, Tint
from minirt.materials.maps import Bump, Checker, Clouds, Marble, NormalMap, Placement, Texture, Wood
from minirt.records import record

GREATEST = 1e6  # exponent: its highlight is a tenth of a degree wide


@record()
class Specular(Material):
    """Specular highlight: `specular:share,exponent[,blinn]`.

    Every light that reaches a point adds `share` of its intensity times cos(a)^`exponent`, whatever the colour of the
    surface. `a` is the angle between the mirrored direction of the light and the direction to the eye (Phong 1975,
    Illumination for Computer Generated Pictures), or with `blinn` the angle between the normal and the direction
    half-way between light and eye (Blinn 1977, Models of Light Reflection for Computer Synthesized Pictures). The
    greater the exponent, the smaller the highlight; with `blinn` a highlight of the same size takes about four times
    the exponent.

        sp 0,0,20 8 200,30,30 specular:0.6,50
    """

    title, feature = "specular", "specular"
    share: float = declare(Real, "share of the light", low=0.0, high=1.0, step=0.05, initial=0.5)
    exponent: float = declare(Factor, "how smooth", high=GREATEST, initial=30.0)
    blinn: bool = declare(Flag, "from the halfway direction", default=False)

    def rows(self, shape: Any, reader: Any) -> dict[str, Any]:
        return {"specular": (self.share, self.exponent, self.blinn)}


# Glow: `glow:share`.
#
# Light of the shape's own, the emitted term of the rendering equation: `share` times the colour of the surface, with
# its texture and checkerboard, is added to the light of every point, whatever shines on it or lies between it and the
# lamps. It is seen by the eye and in mirrors and glass. It lights nothing else: put a lamp beside or inside what
# should.
#
#     sp 0,0,20 8 255,200,120 glow:0.8
Glow = partial(Share, initial=0.5, feature="glow", packed=lambda share, reader: share * reader.gain)

SHARED: dict[str, Any] = {"keyed": True, "sort": "shapes"}
MAPPED: dict[str, Any] = {"mapped": True} | SHARED
MARBLE, WOOD, CLOUDS = ({"key": f"pattern:{name}"} | MAPPED for name in ("marble", "wood", "clouds"))
BOARD: dict[str, Any] = {"record": Checker} | MAPPED


@record(kw_only=True)
class Attributes(Element):
    """The materials that every shape may have; None where it has not."""

    filter: ClassVar[Triple] = (255, 255, 255)  # a colour by which the texture is multiplied, light by light

    specular: Specular | None = declare(Compound, "highlight", record=Specular, default=None, shared=SHARED)
    mirror: Mirror | float | None = declare(Compound, "mirrored light", record=Mirror, default=None, shared=SHARED)
    glass: Glass | None = declare(
        Compound, "refracted light; lamps shine through", record=Glass, default=None, shared=SHARED
    )
    tint: Tint | None = declare(Compound, "colour that glass gives to light", record=Tint, default=None, shared=SHARED)
    fresnel: float | None = declare(Fresnel, "how far Fresnel's equations count", bare="1", default=None, shared=SHARED)
    glow: float | None = declare(Glow, "light of its own, which lights nothing else", default=None, shared=SHARED)
    checker: Checker | None = declare(Compound, "checkerboard", bare="0.125", default=None, shared=BOARD)
    texture: str | None = declare(Texture, "picture in the place of the colour", default=None, shared=MAPPED)
    bump: Bump | None = declare(Compound, "relief", record=Bump, default=None, shared=MAPPED)
    normal_map: str | None = declare(NormalMap, "picture of normals", key="normal", default=None, shared=MAPPED)
    uv: Placement | None = declare(
        Compound, "scale, shift and turn of u and v", record=Placement, default=None, shared=SHARED
    )
    marble: Marble | None = declare(Compound, "veins of marble", record=Marble, default=None, shared=MARBLE)
    wood: Wood | None = declare(Compound, "rings of wood", record=Wood, default=None, shared=WOOD)
    clouds: Clouds | None = declare(Compound, "clouds", record=Clouds, default=None, shared=CLOUDS)

    @property
    def is_mapped(self) -> bool:
        """Whether something lies on the surface that turns with the shape, such as a texture."""
        return any(getattr(self, name) is not None for name in MAPS)


MAPS = tuple(field.name for field in fields_of(Attributes) if field.mapped)

PUBLIC: dict[str, type] = {
    field.record.__name__: field.record for field in fields_of(Attributes) if isinstance(field, Compound)
}
