"""Media: absorption of light inside tinted glass (Beer-Lambert law).

`SceneArrays.media` (n, 6) has for each shape the absorption of red, green and blue inside it, in halvings of the light
for each scene unit, and the shares of red, green and blue that its surface lets through: less than 1 for sheets, which
have no inside. The absorption where shapes overlap is the sum of theirs.
"""

from __future__ import annotations

from typing import Any

from minirt.lanes import Mask, Number, Vec, any, maximum, splat, where
from minirt.lanes.mathematics import LOWEST, exp2

VANISHING = 2.0**-40  # what is left of an absorption after a subtraction, relative to it, that rounding may have left


def absorbed(light: Vec, medium: Vec, distance: Number) -> Vec:
    """Return what is left of light after a distance, which may be infinite, in a medium."""
    if any(maximum(maximum(medium.x, medium.y), medium.z) > 0.0):
        light = Vec(
            light.x * transmittance(medium.x, distance),
            light.y * transmittance(medium.y, distance),
            light.z * transmittance(medium.z, distance),
        )
    return light


def transmittance(absorption: Number, distance: Number) -> Number:
    """Return the share of light that is left: 2^-(absorption * distance)."""
    halvings = where(absorption > 0.0, absorption * distance, 0.0)
    return exp2(maximum(-halvings, LOWEST))


def medium_behind(medium: Vec, rates: Vec, leaves: Mask) -> Vec:
    """Return the medium behind the surface of a shape with the absorption `rates`, which a ray enters or leaves."""
    return Vec(
        rate_behind(medium.x, rates.x, leaves),
        rate_behind(medium.y, rates.y, leaves),
        rate_behind(medium.z, rates.z, leaves),
    )


def rate_behind(rate: Number, change: Number, leaves: Mask) -> Number:
    """Return the absorption of one colour behind a surface, without what rounding leaves."""
    rest = rate - change
    return where(leaves, where(rest > VANISHING * change, rest, 0.0), rate + change)


def filter_of(media: Any, index: int, like: Number) -> Vec:
    """Return the shares of light that the surface of a shape lets through, the same for all rays."""
    return Vec(splat(media[index, 3], like), splat(media[index, 4], like), splat(media[index, 5], like))


def brightest(light: Vec) -> Number:
    """Return the largest channel."""
    return maximum(maximum(light.x, light.y), light.z)
