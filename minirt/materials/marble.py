"""Marble: `marble:size[,R,G,B[,octaves[,height]]]`.

Veins of a second colour, about `size` scene units apart, run through the shape and are moved by turbulence: fractal
noise of absolute values (Perlin 1985, An Image Synthesizer). They move and turn with the shape, and have no seam. They
cover its texture and checkerboard, and lie below wood and clouds, if it has those, too.

The surface is lit as if it were higher where the second colour is, by `height` sizes; a negative height makes grooves.
`octaves` are levels of detail, each twice as fine as the one before; those that are finer than a pixel fade.

    sp 0,0,20 8 235,232,225 marble:1.5,70,75,90
"""

from __future__ import annotations

from minirt.fields import Colour, Length, Triple, declare
from minirt.materials.pattern import Pattern
from minirt.records import record


@record()
class Marble(Pattern):
    """The values of `marble:`."""

    title = "marble"
    size: float = declare(Length, "distance of the veins", initial=0.25)
    colour: Triple = declare(Colour, "colour of the veins", default=(70, 75, 90))
