"""The registry of materials: what surfaces are made of, one class and one field of `Attributes` each.

Another material is a class in `surfaces` or `maps`, with its manual page, and a field here. Parser, writer, editor,
documentation, the public name `minirt.Glass` and the features of the kernel derive from that. What is left to write is
how it is packed (`minirt.rendering.packing.materials`) and how it changes light (`minirt.kernel.shading`).
"""

from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import declare
from minirt.materials.compound import Compound
from minirt.materials.maps import Bump, Checker, Clouds, Marble, NormalMap, Placement, Texture, Wood
from minirt.materials.surfaces import Fresnel, Glass, Glow, Mirror, Specular, Tint
from minirt.records import record

SHARED: dict[str, Any] = {"keyed": True, "sort": "shapes"}
MAPPED: dict[str, Any] = {"mapped": True} | SHARED
BOARD: dict[str, Any] = {"record": Checker, "aliases": ("pat",)} | MAPPED


@record(kw_only=True)
class Attributes(Element):
    """The materials that every shape may have; None where it has not."""

    specular: Specular | None = declare(
        Compound, "highlight", record=Specular, aliases=("spc",), default=None, shared=SHARED
    )
    mirror: Mirror | float | None = declare(
        Compound, "mirrored light", record=Mirror, aliases=("mir",), default=None, shared=SHARED
    )
    glass: Glass | None = declare(
        Compound, "refracted light", record=Glass, aliases=("ref",), default=None, shared=SHARED
    )
    tint: Tint | None = declare(Compound, "colour that glass gives to light", record=Tint, default=None, shared=SHARED)
    fresnel: float | None = declare(Fresnel, "how far Fresnel's equations count", bare="1", default=None, shared=SHARED)
    glow: float | None = declare(Glow, "light of its own", default=None, shared=SHARED)
    checker: Checker | None = declare(Compound, "checkerboard", bare="0.125", default=None, shared=BOARD)
    texture: str | None = declare(
        Texture, "picture in the place of the colour", aliases=("txm", "tx"), default=None, shared=MAPPED
    )
    bump: Bump | None = declare(Compound, "relief", record=Bump, aliases=("bum",), default=None, shared=MAPPED)
    normal_map: str | None = declare(
        NormalMap, "picture of normals", key="normal", aliases=("nm",), default=None, shared=MAPPED
    )
    uv: Placement | None = declare(
        Compound, "scale, shift and turn of u and v", record=Placement, default=None, shared=SHARED
    )
    marble: Marble | None = declare(Compound, "veins of marble", record=Marble, default=None, shared=MAPPED)
    wood: Wood | None = declare(Compound, "rings of wood", record=Wood, default=None, shared=MAPPED)
    clouds: Clouds | None = declare(Compound, "clouds", record=Clouds, default=None, shared=MAPPED)

    @property
    def is_mapped(self) -> bool:
        """Whether something lies on the surface that turns with the shape, such as a texture."""
        return any(getattr(self, name) is not None for name in MAPS)


MAPS = tuple(field.name for field in fields_of(Attributes) if field.mapped)


PUBLIC: dict[str, type] = {
    field.record.__name__: field.record for field in fields_of(Attributes) if isinstance(field, Compound)
}
