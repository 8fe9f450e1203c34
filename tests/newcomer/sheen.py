"""A made-up material for `minirt/materials/__init__.py`: a highlight as wide as can be."""

from __future__ import annotations

from typing import Any

from minirt.fields import Real, declare
from minirt.materials.compound import Material
from minirt.records import record


# What goes into minirt/materials/__init__.py.
@record()
class Sheen(Material):
    """Sheen: `sheen:share`.

    A made-up material: a highlight as wide as can be.

        sp 0,0,20 8 200,120,80 sheen:0.4
    """

    title, feature = "sheen", "specular"
    share: float = declare(Real, "share of the light", low=0.0, high=1.0, step=0.05, initial=0.4)

    def has_effect(self) -> bool:
        return self.share > 0.0

    def rows(self, shape: Any, reader: Any) -> dict[str, Any]:
        return {"specular": (self.share, 1.0, False)}
