"""Bumps: `bump:file[,strength]`, in short `bum:`.

A picture as a relief: the surface stays as it is, but is lit as if its normals were those of one that is higher where
the picture is lighter (Blinn 1978, Simulation of Wrinkled Surfaces). The picture lies on the surface as a texture does;
of a coloured one the luminance counts. White is higher than black by `strength` times the width of the picture as it
lies on the surface there; less than 0 turns heights into depths. The slope at a place is the difference over a pixel
around it. What is mirrored and refracted goes by it, too, unless the surface would throw light below itself.

    sp 0,0,20 8 200,120,80 bump:textures/bricks-height.png,0.02
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from minirt.fields import Picture, Real, declare
from minirt.materials.material import Material


@dataclass(frozen=True)
class Bump(Material):
    """What `bump:` says."""

    title, feature = "bump", "bumps"
    file: str = declare(partial(Picture, also=","), "the heights", heights=True)
    strength: float = declare(Real, "height of white above black", low=-10.0, high=10.0, step=0.005, default=0.02)

    def has_effect(self) -> bool:
        return self.strength != 0.0
