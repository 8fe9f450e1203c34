"""Wood: `wood:size[,R,G,B[,octaves[,height]]]`.

Rings of a second colour around the axis of the shape, `size` scene units apart, with fine grain along it. On flat
shapes the grain runs to the right, and the middle of the trunk lies behind the surface. The rings move and turn with
the shape.
Without values `wood` is `wood:1`. `height` raises the second colour above the first, in sizes, as a bump map does: a
negative one makes grooves. `octaves` are levels of detail, each twice as fine as the one before; those finer than a
pixel fade.

    cy 0,0,20 0,1,0 6 9 200,150,90 wood:0.7
"""

from __future__ import annotations

from minirt.fields import Colour, Triple, declare
from minirt.materials.pattern import Pattern
from minirt.records import record


@record()
class Wood(Pattern):
    """The values of `wood:`."""

    title = "wood"
    colour: Triple = declare(Colour, "colour of the late wood", default=(95, 50, 20))
