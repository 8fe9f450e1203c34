"""Mirror: `mirror:share[,fade]`, in short `mir:`.

`share` of the light seen at a point is that along the mirrored ray (Whitted 1980, An Improved Illumination Model for
Shaded Display). The rest is the surface's own colour; highlights are added to both. With `fade` the mirrored light
loses strength in proportion to the distance of what is mirrored, and is gone at that distance. Rays are followed up to
`--depth` reflections, and not where their share of a pixel is 1/1024 or less. If the shares of mirror and glass add up
to more than 1, both are scaled down alike.

    pl 0,-1,0 0,1,0 200,200,200 mirror:0.3
"""

from __future__ import annotations

from functools import partial

from minirt.fields import FARTHEST, Real, declare
from minirt.materials.material import Material
from minirt.records import record

Fade = partial(Real, low=0.0, high=FARTHEST, step=0.5, unit="scene unit, 0 for never", placeholder="fade")


@record()
class Mirror(Material):
    """The values of `mirror:`."""

    title, feature = "mirror", "reflective"
    share: float = declare(Real, "share of mirrored light", low=0.0, high=1.0, step=0.05, initial=0.3)
    fade: float = declare(Fade, "distance at which mirrored light is gone", default=0.0)

    def has_effect(self) -> bool:
        return self.share > 0.0

    def further_features(self) -> tuple[str, ...]:
        return ("fades",) if self.fade else ()
