"""Materials that change how light leaves a surface: highlights, mirrors, glass and glow.

Each is a class whose text is its manual page, or a field of one number where it has only one value.
"""

from __future__ import annotations

from functools import partial

from minirt.fields import FARTHEST, Colour, Factor, Flag, Length, Real, Triple, declare
from minirt.materials.compound import Material
from minirt.records import record

GREATEST = 1e6  # exponent: its highlight is a tenth of a degree wide


@record()
class Specular(Material):
    """Specular highlight: `specular:share,exponent[,blinn]`, in short `spc:`.

    Every light that reaches a point adds `share` of its intensity times cos(a)^`exponent`, whatever the colour of the
    surface. `a` is the angle between the mirrored direction of the light and the direction to the eye (Phong 1975,
    Illumination for Computer Generated Pictures), or with `blinn` the angle between the normal and the direction
    half-way between light and eye (Blinn 1977, Models of Light Reflection for Computer Synthesized Pictures). The
    greater the exponent, the smaller the highlight; with `blinn` a highlight of the same size takes about four times
    the exponent.

        sp 0,0,20 8 200,30,30 specular:0.6,50
    """

    title, feature = "specular", "specular"
    share: float = declare(Real, "share of the light", low=0.0, high=1.0, step=0.05, initial=0.5)
    exponent: float = declare(Factor, "how smooth", high=GREATEST, initial=30.0)
    blinn: bool = declare(Flag, "from the halfway direction", default=False)

    def has_effect(self) -> bool:
        return self.share > 0.0


Fade = partial(Real, low=0.0, high=FARTHEST, step=0.5, unit="scene unit, 0 for never", placeholder="fade")


@record()
class Mirror(Material):
    """Mirror: `mirror:share[,fade]`, in short `mir:`.

    `share` of the light seen at a point is that along the mirrored ray (Whitted 1980, An Improved Illumination Model
    for Shaded Display). The rest is the surface's own colour; highlights are added to both. With `fade` the mirrored
    light loses strength in proportion to the distance of what is mirrored, and is gone at that distance. Rays are
    followed up to `--depth` reflections, and not where their share of a pixel is 1/1024 or less. If the shares of
    mirror and glass add up to more than 1, both are scaled down alike.

        pl 0,-1,0 0,1,0 200,200,200 mirror:0.3
    """

    title, feature = "mirror", "reflective"
    share: float = declare(Real, "share of mirrored light", low=0.0, high=1.0, step=0.05, initial=0.3)
    fade: float = declare(Fade, "distance at which mirrored light is gone", default=0.0)

    def has_effect(self) -> bool:
        return self.share > 0.0

    def further_features(self) -> tuple[str, ...]:
        return ("fades",) if self.fade else ()


@record()
class Glass(Material):
    """Glass: `glass:ior[,share[,fade]]`, in short `ref:`.

    `share` of the light seen at a point, all of it when left out, comes through the surface (Whitted 1980, An Improved
    Illumination Model for Shaded Display). It is refracted by Snell's law, with the index of refraction `ior` inside
    and 1 outside, or mirrored where the angle is too flat to leave (total internal reflection). A shape without inside,
    such as a plane, counts the side that its normal points away from as inside. Water has 1.33, glass 1.5, diamond
    2.42; with 1 light goes straight on. With `fade` the refracted light loses strength in proportion to the distance
    from the surface, and is gone at that distance.

    Lamps shine through glass: every surface between a point and a lamp lets its `share` through, so that a ball does
    twice and a pane once, times its `tint:` and, with `fresnel`, what is not reflected at that angle. The light goes
    straight on, without refraction: there are no caustics.

        sp 0,0,20 8 255,255,255 glass:1.5,0.9
    """

    title, feature = "glass", "reflective"
    ior: float = declare(Real, "index of refraction", low=1.0, high=10.0, step=0.02, initial=1.5)
    share: float = declare(Real, "share that comes through", low=0.0, high=1.0, step=0.05, default=1.0)
    fade: float = declare(Fade, "distance at which refracted light is gone", default=0.0)

    def has_effect(self) -> bool:
        return self.share > 0.0

    def further_features(self) -> tuple[str, ...]:
        return ("transparent", "fades") if self.fade else ("transparent",)


@record()
class Tint(Material):
    """Tint of glass: `tint:R,G,B[,distance]`.

    The colour of light that was white and has gone `distance` through the glass, one scene unit when left out. Of each
    channel `(c / 255) ^ (d / distance)` is left after a way of the length d inside (Beer-Lambert law): twice the
    distance leaves the square. This holds for what is seen through the glass and for light from lamps. Where solids
    overlap both absorb. A plane counts the side that its normal points away from as inside; a mesh must be closed.
    Squares, discs and triangles have no inside: they tint light once each time that it crosses them, as after
    `distance`.

    A shape without `glass:` shows no tint.

        sp 0,0,20 8 255,255,255 glass:1.5 tint:120,220,160,4
    """

    title, feature = "tint", "media"
    colour: Triple = declare(Colour, "what is left of white light", initial=(120, 200, 160))
    distance: float = declare(Length, "way inside after which it is left", default=1.0)

    def has_effect(self) -> bool:
        return self.colour != (255, 255, 255)


# Fresnel reflection of glass and mirrors: `fresnel:share`; `fresnel` alone is `fresnel:1`.
#
# The shares of reflected and refracted light follow Fresnel's equations for unpolarised light: little is reflected
# where one looks along the normal, all where one looks along the surface. `share` mixes them with the constant shares;
# at 0 these alone count.
#
# Glass of the index n reflects ((n - 1) / (n + 1))^2 of the light along the normal, 4 % for 1.5, of the share that
# `glass:` and `mirror:` have together; the rest of that share is refracted. A mirror that is no glass reflects its own
# share along the normal and more elsewhere, as a transparent varnish of the index (1 + sqrt(share)) / (1 - sqrt(share))
# does: `mirror:0.04` is a polished floor. A shape with neither `glass:` nor `mirror:` shows no difference.
#
#     sp 0,0,20 8 255,255,255 glass:1.5 fresnel
Fresnel = partial(Real, unit="ratio", low=0.0, high=1.0, step=0.1, placeholder="share", initial=1.0, feature="fresnel")


# Glow: `glow:share`.
#
# Light of the shape's own, the emitted term of the rendering equation: `share` times the colour of the surface, with
# its texture and checkerboard, is added to the light of every point, whatever shines on it or lies between it and the
# lamps. It is seen by the eye and in mirrors and glass. It lights nothing else: put a lamp beside or inside what
# should.
#
#     sp 0,0,20 8 255,200,120 glow:0.8
Glow = partial(Real, unit="ratio", low=0.0, high=1.0, step=0.05, placeholder="share", initial=0.5, feature="glow")
