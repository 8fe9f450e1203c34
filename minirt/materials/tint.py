"""Tint of glass: `tint:R,G,B[,distance]`.

The colour of light that was white and has gone `distance` through the glass, one scene unit when left out. Of each
channel `(c / 255) ^ (d / distance)` is left after a way of the length d inside (Beer-Lambert law): twice the distance
leaves the square. This holds for what is seen through the glass and for light from lamps. Where solids overlap both
absorb. A plane counts the side that its normal points away from as inside; a mesh must be closed. Squares, discs and
triangles have no inside: they tint light once each time that it crosses them, as after `distance`.

A shape without `glass:` shows no tint.

    sp 0,0,20 8 255,255,255 glass:1.5 tint:120,220,160,4
"""

from __future__ import annotations

from minirt.fields import Colour, Length, Triple, declare
from minirt.materials.material import Material
from minirt.records import record


@record()
class Tint(Material):
    """The values of `tint:`."""

    title, feature = "tint", "media"
    colour: Triple = declare(Colour, "what is left of white light", initial=(120, 200, 160))
    distance: float = declare(Length, "way inside after which it is left", default=1.0)

    def has_effect(self) -> bool:
        return self.colour != (255, 255, 255)
