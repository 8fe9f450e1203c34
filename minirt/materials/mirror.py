"""Mirror: `mirror:share`, in short `mir:`.

`share` of what is seen at a point is what the mirrored ray meets (Whitted 1980, An Improved Illumination Model for
Shaded Display). The rest is the surface's own colour; highlights come on top of both. Rays are followed to the depth
of `--depth`, and not where their share of a pixel is 1/1024 or less. Where mirror and glass have more than all of the
light together, both get less alike.

    pl 0,-1,0 0,1,0 200,200,200 mirror:0.3
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Real

Mirror = partial(
    Real, unit="ratio", low=0.0, high=1.0, step=0.05, placeholder="share", initial=0.3, feature="reflective"
)
