"""Texture: `texture:file`, in short `txm:`.

A picture that gives the surface its colours. It lies on the surface's coordinates u, from its left to its right border,
and v, from its lower to its upper border, and is repeated beyond them. PNG, JPEG and other raster formats are read; the
path begins at the folder of the scene file, and must not contain blanks or `#`.

    sp 0,0,20 8 255,255,255 texture:textures/planet.png
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Picture

Texture = partial(Picture, feature="textures")
