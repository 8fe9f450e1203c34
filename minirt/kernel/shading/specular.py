"""Highlights: light that a glossy surface throws into one direction more than into others."""

from __future__ import annotations

from minirt.lanes import Vec, any, dot, minimum, splat, unit, where
from minirt.lanes.operations import Mask
from minirt.lanes.power import power
from minirt.lanes.vec import Number


def specular(look: Vec, normal: Vec, towards: Vec, direction: Vec, lit: Mask) -> Number:
    """The share of a lamp's light that is seen as a highlight along `direction`, for the rays that are `lit`.

    `look` is a row of `Traced.gloss`: the coefficient k, the exponent n and 1 for Blinn's form. Phong 1975: k (r.v)^n
    with the mirrored direction r of the lamp and the direction v of the eye; Blinn 1977: k (n.h)^n with the vector h
    halfway between lamp and eye.
    """
    mirrored = 2.0 * dot(normal, towards) * dot(normal, -direction) + dot(towards, direction)
    halfway = dot(normal, unit(towards - direction))
    base = minimum(where(look.z > 0.5, halfway, mirrored), 1.0)
    shining = lit & (base > 0.0) & (look.x > 0.0)
    share = splat(0.0, base)
    if any(shining):
        share = where(shining, look.x * power(where(shining, base, 1.0), look.y), 0.0)
    return share
