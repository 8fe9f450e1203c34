"""Mirror: `mirror:share`, in short `mir:`.

`share` of the light seen at a point is that along the mirrored ray (Whitted 1980, An Improved Illumination Model for
Shaded Display). The rest is the surface's own colour; highlights are added to both. Rays are followed up to `--depth`
reflections, and not where their share of a pixel is 1/1024 or less. If the shares of mirror and glass add up to more
than 1, both are scaled down alike.

    pl 0,-1,0 0,1,0 200,200,200 mirror:0.3
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Real

Mirror = partial(
    Real, unit="ratio", low=0.0, high=1.0, step=0.05, placeholder="share", initial=0.3, feature="reflective"
)
