"""Clouds: `clouds:size[,R,G,B[,octaves[,height]]]`.

Soft spots of a second colour, about `size` scene units wide: fractal noise (Perlin 1985, An Image Synthesizer). They
move and turn with the shape, and have no seam. They cover its texture, checkerboard and all other patterns.

The surface is lit as if it were higher where the second colour is, by `height` sizes; a negative height makes grooves.
`octaves` are levels of detail, each twice as fine as the one before; those that are finer than a pixel fade.

    sp 0,0,20 8 60,120,210 clouds:3
"""

from __future__ import annotations

from minirt.fields import Colour, Length, Triple, declare
from minirt.materials.pattern import Pattern
from minirt.records import record


@record()
class Clouds(Pattern):
    """The values of `clouds:`."""

    title = "clouds"
    size: float = declare(Length, "width of a large cloud", initial=0.25)
    colour: Triple = declare(Colour, "colour of the clouds", default=(255, 255, 255))
