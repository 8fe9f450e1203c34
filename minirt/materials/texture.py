"""Texture: `texture:file`, in short `txm:`.

The colours of a picture in the place of the surface's own: the picture lies on the surface's coordinates u, from left
to right, and v, from its lower to its upper border, and is repeated beyond them. PNG, JPEG and other files of pixels
will do; the path begins at the folder of the scene file, and has no blanks and no `#` in it.

    sp 0,0,20 8 255,255,255 texture:textures/planet.png
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Picture

Texture = partial(Picture, feature="textures")
