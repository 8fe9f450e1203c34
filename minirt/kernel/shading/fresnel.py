"""Fresnel's equations: the share of unpolarised light that the surface of a transparent material reflects."""

from __future__ import annotations

from minirt.lanes import Number, Vec, maximum, sqrt, where

TINY = 2.0**-500  # keeps the quotients finite where a ray grazes a surface between two equal indices


def reflectance(cosine: Number, ratio: Number) -> Number:
    """Return the share of the light that is reflected, the mean over both polarisations (Fresnel 1823).

    `cosine` >= 0 is that of the angle between the ray and the normal. `ratio` is the index of refraction before the
    surface by that behind it. The rest of the light is refracted; it is none beyond the angle of total reflection.
    """
    squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine)
    behind = sqrt(maximum(squared, 0.0))  # cosine of the angle between the refracted ray and the normal
    across = (ratio * cosine - behind) / maximum(ratio * cosine + behind, TINY)
    along = (cosine - ratio * behind) / maximum(cosine + ratio * behind, TINY)
    return where(squared < 0.0, 1.0, 0.5 * (across * across + along * along))


def shares_at_angle(reflective: Vec, fresnel: Number, cosine: Number, against: Number) -> Vec:
    """Return a row of `SceneArrays.reflective` with the shares of reflection and refraction for the angle of a ray.

    Glass divides both shares together by Fresnel's equations; the share of a mirror that is no glass grows as that of a
    varnish. `fresnel`, from 0 to 1, mixes these shares with the constant ones. A ray that leaves glass has
    `against` < 0; a mirror is alike on both sides.
    """
    constant, refracted, ior = reflective.x, reflective.y, reflective.z
    is_glass = refracted > 0.0
    share = reflectance(cosine, where(is_glass & (against < 0.0), ior, 1.0 / ior))
    reflected = constant + fresnel * (share * where(is_glass, constant + refracted, 1.0) - constant)
    return Vec(reflected, where(is_glass, constant + refracted - reflected, 0.0), where(is_glass, ior, 1.0))
