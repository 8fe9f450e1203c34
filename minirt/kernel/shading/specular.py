"""Specular highlights (Phong 1975, Blinn 1977)."""

from __future__ import annotations

from minirt.lanes import Mask, Number, Vec, any, dot, minimum, splat, unit, where
from minirt.lanes.mathematics import power


def specular(material: Vec, normal: Vec, to_light: Vec, direction: Vec, lit: Mask) -> Number:
    """Return the share of a light source's intensity that is reflected as a highlight, for the rays that are `lit`.

    `direction` is that of the viewing ray. `material` is a row of `SceneArrays.specular`: coefficient k, exponent n and
    1 for Blinn's form. Phong 1975: k (r.v)^n with the mirrored direction r of the light and the direction v of the
    viewer; Blinn 1977: k (n.h)^n with the vector h halfway between light and viewer.
    """
    phong = 2.0 * dot(normal, to_light) * dot(normal, -direction) + dot(to_light, direction)
    blinn = dot(normal, unit(to_light - direction))
    base = minimum(where(material.z > 0.5, blinn, phong), 1.0)
    shining = lit & (base > 0.0) & (material.x > 0.0)
    share = splat(0.0, base)
    if any(shining):
        share = where(shining, material.x * power(where(shining, base, 1.0), material.y), 0.0)
    return share
