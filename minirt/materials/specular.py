"""Specular highlight: `specular:share,exponent[,blinn]`, in short `spc:`.

Every light that reaches a point adds `share` of its intensity times cos(a)^`exponent`, whatever the colour of the
surface. `a` is the angle between the mirrored direction of the light and the direction to the eye (Phong 1975,
Illumination for Computer Generated Pictures), or with `blinn` the angle between the normal and the direction half-way
between light and eye (Blinn 1977, Models of Light Reflection for Computer Synthesized Pictures). The greater the
exponent, the smaller the highlight; with `blinn` a highlight of the same size takes about four times the exponent.

    sp 0,0,20 8 200,30,30 specular:0.6,50
"""

from __future__ import annotations

from minirt.fields import Factor, Flag, Real, declare
from minirt.materials.material import Material
from minirt.records import record

GREATEST = 1e6  # exponent: its highlight is a tenth of a degree wide


@record()
class Specular(Material):
    """The values of `specular:`."""

    title, feature = "specular", "specular"
    share: float = declare(Real, "share of the light", low=0.0, high=1.0, step=0.05, initial=0.5)
    exponent: float = declare(Factor, "how smooth", high=GREATEST, initial=30.0)
    blinn: bool = declare(Flag, "from the halfway direction", default=False)

    def has_effect(self) -> bool:
        return self.share > 0.0
