"""What rays see that hit nothing: a colour, or a picture around the scene."""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from minirt.kernel.texels import picture_at
from minirt.lanes import Vec, any, maximum, minimum, splat, sqrt, where
from minirt.lanes.angle import arctan2
from minirt.lanes.vec import Number
from minirt.lanes.verbs import Mask


class Dome(NamedTuple):
    """A picture of all directions, equirectangular: +z is its middle, +y its upper edge, -x to the right of +z."""

    texels: Any  # as in `minirt.kernel.skins`
    pictures: Any  # its only row


def lit_sky(sky: Any, dome: Any, hit: Mask, light: Vec, direction: Vec) -> Vec:
    """The light of rays that hit, and of the sky for those that do not."""
    return painted_sky(dome, hit, coloured_sky(sky, hit, light), direction)


def beyond(sky: Any, dome: Any, weight: Number, direction: Vec) -> Vec:
    """The light of the sky in a direction, times a weight."""
    nothing = splat(0.0, weight)
    dark = Vec(nothing, nothing, nothing)
    return where(weight > 0.0, weight * lit_sky(sky, dome, weight < 0.0, dark, direction), dark)


def coloured_sky(sky: Any, hit: Mask, light: Vec) -> Vec:
    """A sky of one colour."""
    if sky is None:
        return light
    return where(hit, light, Vec(sky[0], sky[1], sky[2]))


def painted_sky(dome: Any, hit: Mask, light: Vec, direction: Vec) -> Vec:
    """A picture around the scene."""
    if dome is None:
        return light
    if any(~hit):
        u, v = longitude_and_latitude(direction)
        edge = 0.5 / dome.pictures[0, 2]  # nothing is above the upper row of pixels
        seen = picture_at(dome.texels, dome.pictures, 0, u, minimum(maximum(v, edge), 1.0 - edge))
        light = where(hit, light, seen)
    return light


def longitude_and_latitude(direction: Vec) -> tuple[Number, Number]:
    """Where a direction is in such a picture: from 0 to 1 from left to right and from below to above."""
    u = 0.5 + arctan2(-direction.x, direction.z) * (0.5 / pi)
    v = 0.5 + arctan2(direction.y, sqrt(direction.x * direction.x + direction.z * direction.z)) * (1.0 / pi)
    return u, v


def is_plain(dome: Any) -> bool:
    """Whether the sky looks the same everywhere."""
    return dome is None
