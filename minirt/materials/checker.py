"""Checkerboard: `checker:size[,R,G,B]`, in short `pat:`; `checker` alone is `checker:0.125`, on planes `checker:1`.

Squares with sides of length `size` in the surface's coordinates u and v have in turn the colour of the surface (or its
texture) and the second colour, black when left out. The square with 0 <= u < size and 0 <= v < size has the colour of
the surface. On a plane u and v are lengths; on other shapes they run from 0 to 1 from edge to edge or once
around, as their manual pages say, so that a size of 0.125 makes a board of 8 by 8.

    pl 0,-1,0 0,1,0 255,255,255 checker:2,40,40,60
"""

from __future__ import annotations

from minirt.fields import Colour, Length, Triple, declare
from minirt.materials.material import Material
from minirt.records import record


@record()
class Checker(Material):
    """The values of `checker:`."""

    title, feature = "checker", "checks"
    size: float = declare(Length, "side of a square, in u and v", unit="")
    colour: Triple = declare(Colour, "the second colour", default=(0, 0, 0))
