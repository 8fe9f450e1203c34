"""Marble: `marble:size[,R,G,B[,octaves[,height]]]`.

Veins of a second colour, about `size` scene units apart, run through the shape and are moved by turbulence: fractal
noise of absolute values (Perlin 1985, An Image Synthesizer). They move and turn with the shape, and have no seam.
Without values `marble` is `marble:1`. `height` raises the second colour above the first, in sizes, as a bump map does: a
negative one makes grooves. `octaves` are levels of detail, each twice as fine as the one before; those finer than a
pixel fade.

    sp 0,0,20 8 235,232,225 marble:1.5,70,75,90
"""

from __future__ import annotations

from minirt.fields import Colour, Triple, declare
from minirt.materials.pattern import Pattern
from minirt.records import record


@record()
class Marble(Pattern):
    """The values of `marble:`."""

    title = "marble"
    colour: Triple = declare(Colour, "colour of the veins", default=(70, 75, 90))
