"""A made-up material for `minirt/materials/__init__.py`: a matt surface that is rough, such as clay."""

from __future__ import annotations

from typing import Any

from minirt.fields import Real, declare
from minirt.materials.compound import Material
from minirt.records import record


# What goes into minirt/materials/__init__.py.
@record()
class Rough(Material):
    """Roughness: `rough:slope`.

    A made-up material: a matt surface whose facets have this slope, such as clay (Oren and Nayar 1994).

        sp 0,0,20 8 200,120,80 rough:0.5
    """

    title, feature = "rough", "rough"
    slope: float = declare(Real, "of its facets, the standard deviation", low=0.0, high=1.0, step=0.05, initial=0.5)

    def has_effect(self) -> bool:
        return self.slope > 0.0

    def rows(self, shape: Any, reader: Any) -> dict[str, Any]:
        return {"rough": self.slope**2}
