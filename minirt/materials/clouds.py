"""Clouds: `clouds:size[,R,G,B[,octaves[,height]]]`.

Soft spots of a second colour, about `size` scene units wide: fractal noise (Perlin 1985, An Image Synthesizer). They
move and turn with the shape, and have no seam.
Without values `clouds` is `clouds:1`. `height` raises the second colour above the first, in sizes, as a bump map does: a
negative one makes grooves. `octaves` are levels of detail, each twice as fine as the one before; those finer than a
pixel fade.

    sp 0,0,20 8 60,120,210 clouds:3
"""

from __future__ import annotations

from minirt.fields import Colour, Triple, declare
from minirt.materials.pattern import Pattern
from minirt.records import record


@record()
class Clouds(Pattern):
    """The values of `clouds:`."""

    title = "clouds"
    colour: Triple = declare(Colour, "colour of the clouds", default=(255, 255, 255))
