"""Glass: `glass:ior[,share[,fade]]`, in short `ref:`.

`share` of the light seen at a point, all of it when left out, comes through the surface (Whitted 1980, An Improved
Illumination Model for Shaded Display). It is refracted by Snell's law, with the index of refraction `ior` inside and 1
outside, or mirrored where the angle is too flat to leave (total internal reflection). A shape without inside, such as a
plane, counts the side that its normal points away from as inside. Water has 1.33, glass 1.5, diamond 2.42; with 1 light
goes straight on. With `fade` the refracted light loses strength in proportion to the distance from the surface, and is
gone at that distance.

Lamps shine through glass: every surface between a point and a lamp lets its `share` through, so that a ball does twice
and a pane once, times its `tint:` and, with `fresnel`, what is not reflected at that angle. The light goes straight on,
without refraction: there are no caustics.

    sp 0,0,20 8 255,255,255 glass:1.5,0.9
"""

from __future__ import annotations

from minirt.fields import Real, declare
from minirt.materials.material import Material
from minirt.materials.mirror import Fade
from minirt.records import record


@record()
class Glass(Material):
    """The values of `glass:`."""

    title, feature = "glass", "reflective"
    ior: float = declare(Real, "index of refraction", low=1.0, high=10.0, step=0.02, initial=1.5)
    share: float = declare(Real, "share that comes through", low=0.0, high=1.0, step=0.05, default=1.0)
    fade: float = declare(Fade, "distance at which refracted light is gone", default=0.0)

    def has_effect(self) -> bool:
        return self.share > 0.0

    def further_features(self) -> tuple[str, ...]:
        return ("transparent", "fades") if self.fade else ("transparent",)
