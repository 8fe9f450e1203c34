"""Placement of pictures: `uv:su,sv[,ou[,ov[,degrees]]]`.

Scales, turns and shifts the surface's u and v for its checkerboard, texture, bump map and normal map. A picture becomes
`su` times narrower and `sv` times lower, so that there are `su` times `sv` pictures where one was; it is turned by
`degrees` about its lower left corner, counter-clockwise as seen from outside; and that corner is put at u = `ou`,
v = `ov`. On a plane, where u and v are lengths, `uv:0.25,0.5` makes pictures four units wide and two units high.

    pl 0,-1,0 0,1,0 255,255,255 texture:textures/bricks.png uv:0.25,0.5
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Angle, Length, Real, declare
from minirt.materials.material import Material
from minirt.records import record

FARTHEST = 1e6  # in u or v
Scale = partial(Length, unit="", initial=2.0)
Shift = partial(Real, low=-FARTHEST, high=FARTHEST, step=0.05)


@record()
class Placement(Material):
    """The values of `uv:`."""

    title, feature = "uv", "placements"
    scale_u: float = declare(Scale, "pictures in a unit of u", placeholder="su")
    scale_v: float = declare(Scale, "pictures in a unit of v", placeholder="sv")
    shift_u: float = declare(Shift, "u of the lower left corner", placeholder="ou", default=0.0)
    shift_v: float = declare(Shift, "v of the lower left corner", placeholder="ov", default=0.0)
    turn: float = declare(
        Angle, "turn about that corner, counter-clockwise", placeholder="degrees", step=5.0, default=0.0
    )

    def has_effect(self) -> bool:
        return self != Placement(1.0, 1.0)
