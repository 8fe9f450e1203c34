"""Light on rough matt surfaces (Oren and Nayar 1994, Generalization of Lambert's Reflectance Model)."""

from __future__ import annotations

from minirt.lanes import Number, Vec, dot, maximum, where


def rough_share(squared: Number, normal: Vec, to_light: Vec, direction: Vec) -> Number:
    """Return the light that a surface sends towards the eye, as a share of what Lambert's law gives.

    `squared` is the square of the standard deviation of the slopes of its facets; `direction` is that of the viewing
    ray. It is the qualitative model of the paper, without light from facet to facet.
    """
    light, eye = dot(normal, to_light), -dot(normal, direction)
    facing = -dot(to_light, direction) - light * eye  # sines of both angles times the cosine of the azimuth between
    steeper = maximum(maximum(light, eye), 1e-6)  # sin a tan b is the product of both sines over this cosine
    flat = 1.0 - 0.5 * squared / (squared + 0.33)
    return flat + where(facing > 0.0, 0.45 * squared / (squared + 0.09) * facing / steeper, 0.0)
