"""Bump map: `bump:file[,strength]`, in short `bum:`.

Bump mapping (Blinn 1978, Simulation of Wrinkled Surfaces): the picture is a height map, and the surface is lit as if it
were higher where the picture is lighter; its shape stays as it is. The picture lies on the surface as a texture does;
of a coloured one the luminance counts. White is higher than black by `strength` times the width of the picture on the
surface; a negative strength turns heights into depths. The slope at a point is the difference over one pixel around it.
Mirrored and refracted rays follow the bumped normal, too, unless they would leave on the wrong side of the surface.

    sp 0,0,20 8 200,120,80 bump:textures/bricks-height.png,0.02
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Picture, Real, declare
from minirt.materials.material import Material
from minirt.records import record


@record()
class Bump(Material):
    """The values of `bump:`."""

    title, feature = "bump", "bumps"
    file: str = declare(partial(Picture, also=","), "the heights", heights=True)
    strength: float = declare(Real, "height of white above black", low=-10.0, high=10.0, step=0.005, default=0.02)

    def has_effect(self) -> bool:
        return self.strength != 0.0
