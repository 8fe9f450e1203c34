"""Mirrors, glass and its tint, and Fresnel's equations for both.

Each is a class whose text is its manual page, or a field of one number where it has only one value.
"""

from __future__ import annotations

from functools import partial
from math import log2, sqrt
from typing import Any

from minirt.fields import FARTHEST, Colour, Length, Real, Triple, declare
from minirt.materials.compound import Material, Share
from minirt.records import record

BLACK = 1e30  # absorption, in halvings for each scene unit, of what lets nothing of a colour through
HIGHEST_ROOT = 1.0 - 1e-9  # of the reflectance of a varnish; that of a perfect mirror would have an infinite index
Fade = partial(Real, low=0.0, high=FARTHEST, step=0.5, unit="scene unit, 0 for never")


class Secondary(Material):
    """Base of materials that send secondary rays; without a share they have no effect."""

    feature = "reflective"
    share: float
    fade: float

    def features(self) -> tuple[str, ...]:
        return (*super().features(), "fades") if self.fade and self.share else super().features()

    def rows(self, shape: Any, reader: Any) -> dict[str, Any]:
        """The rows of a shape with `mirror:` or `glass:`, the same for both.

        They have the shares of mirrored and refracted light, scaled down to 1 where their sum exceeds it, and the index
        of refraction; and one over the distances at which either light is gone, 0 for never.
        """
        mirror, glass = mirror_of(shape), shape.glass or Glass(1.0, 0.0)
        total = max(1.0, mirror.share + glass.share)
        row = mirror.share / total, glass.share / total, refractive_index(shape)
        fades = [1.0 / fade if fade else 0.0 for fade in (mirror.fade, glass.fade)]
        through = {"transparent": (*row, shape.fresnel or 0.0, 0.0)} if shape.glass else {}
        return {"reflective": row, "fades": fades, **through}


@record()
class Mirror(Secondary):
    """Mirror: `mirror:share[,range]`.

    `share` of the light seen at a point is that along the mirrored ray (Whitted 1980, An Improved Illumination Model
    for Shaded Display). The rest is the surface's own colour; highlights are added to both. With `range` the mirrored
    light loses strength in proportion to the distance of what is mirrored, and is gone at that distance. Rays are
    followed up to `--depth` reflections, and not where their share of a pixel is 1/1024 or less. If the shares of
    mirror and glass add up to more than 1, both are scaled down alike.

        pl 0,-1,0 0,1,0 200,200,200 mirror:0.3
    """

    title = "mirror"
    share: float = declare(Real, "share of mirrored light", low=0.0, high=1.0, step=0.05, initial=0.8)
    fade: float = declare(Fade, "distance at which mirrored light is gone", default=0.0, placeholder="range")


@record()
class Glass(Secondary):
    """Glass: `glass:ior[,share[,visibility]]`.

    `share` of the light seen at a point, all of it when left out, comes through the surface (Whitted 1980, An Improved
    Illumination Model for Shaded Display). It is refracted by Snell's law, with the index of refraction `ior` inside
    and 1 outside, or mirrored where the angle is too flat to leave (total internal reflection). A shape without inside,
    such as a plane, counts the side that its normal points away from as inside. Water has 1.33, glass 1.5, diamond
    2.42; with 1 light goes straight on. `share` counts at each surface: of what lies behind a ball of share 0.9, which
    has two in a row, 0.81 is seen. With `visibility` the refracted light loses strength in proportion to the distance
    from the surface, and is gone at that distance.

    Lamps shine through glass: every surface between a point and a lamp lets its `share` through, so that a ball does
    twice and a pane once, times its `tint:` and, with `fresnel`, what is not reflected at that angle. The light goes
    straight on, without refraction: there are no caustics.

        sp 0,0,20 8 255,255,255 glass:1.5,0.9
    """

    title = "glass"
    ior: float = declare(Real, "index of refraction", low=1.0, high=10.0, step=0.02, initial=1.5)
    share: float = declare(Real, "share that comes through", low=0.0, high=1.0, step=0.05, default=1.0, initial=0.9)
    fade: float = declare(Fade, "distance at which refracted light is gone", default=0.0, placeholder="visibility")

    def features(self) -> tuple[str, ...]:
        return (*super().features(), "transparent") if self.share else ()


def mirror_of(shape: Any) -> Mirror:
    """Return the mirror of a shape; one of share 0 where it has none."""
    return shape.mirror if isinstance(shape.mirror, Mirror) else Mirror(0.0)


def refractive_index(shape: Any) -> float:
    """Return the refractive index of a shape; that of a varnish where it is a mirror with Fresnel reflection."""
    if shape.glass and shape.glass.share:
        return float(shape.glass.ior)
    if not shape.fresnel:
        return 1.0
    root = min(sqrt(mirror_of(shape).share), HIGHEST_ROOT)
    return (1.0 + root) / (1.0 - root)


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

    title, feature, needs = "tint", "media", ("glass",)
    colour: Triple = declare(Colour, "what is left of white light", initial=(120, 200, 160))
    distance: float = declare(Length, "way inside after which it is left", default=1.0)

    def has_effect(self) -> bool:
        return self.colour != (255, 255, 255)

    def rows(self, shape: Any, reader: Any) -> dict[str, Any]:
        if not (shape.glass and shape.glass.share):
            return {}
        if shape.solid:
            return {"media": (*self.absorption(reader), 1.0, 1.0, 1.0)}
        return {"media": (0.0, 0.0, 0.0, *reader.shares(self.colour))}

    def absorption(self, reader: Any) -> list[float]:
        """The absorption of red, green and blue inside, in halvings for each scene unit."""
        return [-log2(share) / self.distance if share else BLACK for share in reader.shares(self.colour)]


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
Fresnel = partial(
    Share, step=0.1, initial=1.0, feature="fresnel", needs=("glass", "mirror"), packed=lambda share, _: share
)
