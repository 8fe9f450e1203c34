"""Normal map: `normal:file`, in short `nm:`.

A picture whose colours are the normals with which the surface is lit; it lies on the surface as a texture does. Red is
the component along u, green that along v, blue that along the surface's own normal: 1 means -1, 128 means 0, 255 means
1. The colour 128,128,255 changes nothing (Cohen, Olano and Manocha 1998, Appearance-Preserving Simplification).

    sp 0,0,20 8 200,120,80 normal:textures/bricks-normal.png
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Picture

NormalMap = partial(Picture, feature="normals")
