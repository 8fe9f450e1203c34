"""Glow: `glow:share`.

Light of the shape's own, the emitted term of the rendering equation: `share` times the colour of the surface, with its
texture and checkerboard, is added to the light of every point, whatever shines on it or lies between it and the lamps.
It is seen by the eye and in mirrors and glass. It lights nothing else: put a lamp beside or inside what should.

    sp 0,0,20 8 255,200,120 glow:0.8
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Real

Glow = partial(Real, unit="ratio", low=0.0, high=1.0, step=0.05, placeholder="share", initial=0.5, feature="glow")
