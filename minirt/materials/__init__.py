"""The registry of materials: what surfaces are made of, one file and one field of `Attributes` each.

Another material is a file beside these with its manual page, and here its import and its field. Parser, writer, editor,
documentation, the public name `minirt.Glass` and the features of the kernel derive from that. What is left to write is
how it is packed (`minirt.rendering.packing.materials`) and how it changes light (`minirt.kernel.shading`).
"""

from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import declare
from minirt.materials.bump import Bump as Bump
from minirt.materials.checker import Checker as Checker
from minirt.materials.clouds import Clouds as Clouds
from minirt.materials.compound import Compound as Compound
from minirt.materials.glass import Glass as Glass
from minirt.materials.marble import Marble as Marble
from minirt.materials.mirror import Mirror as Mirror
from minirt.materials.normal_map import NormalMap as NormalMap
from minirt.materials.specular import Specular as Specular
from minirt.materials.texture import Texture as Texture
from minirt.materials.wood import Wood as Wood
from minirt.records import record

SHARED: dict[str, Any] = {"keyed": True, "sort": "shapes"}
BOARD: dict[str, Any] = {"record": Checker, "aliases": ("pat",)} | SHARED


@record(kw_only=True)
class Attributes(Element):
    """The materials that every shape may have; None where it has not."""

    specular: Specular | None = declare(Compound, "highlight", record=Specular, aliases=("spc",), **SHARED)
    mirror: float | None = declare(Mirror, "share of mirrored light", aliases=("mir",), **SHARED)
    glass: Glass | None = declare(Compound, "refracted light", record=Glass, aliases=("ref",), **SHARED)
    checker: Checker | None = declare(Compound, "checkerboard", bare="0.125", **BOARD)
    texture: str | None = declare(Texture, "picture in the place of the colour", aliases=("txm", "tx"), **SHARED)
    bump: Bump | None = declare(Compound, "relief", record=Bump, aliases=("bum",), **SHARED)
    normal_map: str | None = declare(NormalMap, "picture of normals", key="normal", aliases=("nm",), **SHARED)
    marble: Marble | None = declare(Compound, "veins of marble", record=Marble, **SHARED)
    wood: Wood | None = declare(Compound, "rings of wood", record=Wood, **SHARED)
    clouds: Clouds | None = declare(Compound, "clouds", record=Clouds, **SHARED)


PUBLIC: dict[str, type] = {
    field.record.__name__: field.record for field in fields_of(Attributes) if isinstance(field, Compound)
}
