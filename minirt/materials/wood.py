"""Wood: `wood:size[,R,G,B[,octaves[,height]]]`.

Rings of a second colour around the axis of the shape, `size` scene units apart, with fine grain along it. On flat
shapes the grain runs to the right, and the middle of the rings lies behind the surface. The rings move and turn with
the shape. They cover its texture, checkerboard and marble.

The surface is lit as if it were higher where the second colour is, by `height` sizes; a negative height makes grooves.
`octaves` are levels of detail, each twice as fine as the one before; the grain begins with the third one.

    cy 0,0,20 0,1,0 6 9 200,150,90 wood:0.7
"""

from __future__ import annotations

from minirt.fields import Colour, Length, Triple, declare
from minirt.materials.pattern import Pattern
from minirt.records import record


@record()
class Wood(Pattern):
    """The values of `wood:`."""

    title = "wood"
    size: float = declare(Length, "distance of the rings", initial=0.25)
    colour: Triple = declare(Colour, "colour of the late wood", default=(95, 50, 20))
