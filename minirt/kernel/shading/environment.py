"""What rays see that hit nothing: a colour, or a picture around the scene."""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import Traced
from minirt.kernel.shading.texture_lookup import picture_at
from minirt.lanes import Vec, any, maximum, minimum, splat, sqrt, where
from minirt.lanes.angle import arctan2
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number


class Dome(NamedTuple):
    """A picture of all directions, equirectangular: +z is its middle, +y its upper edge, -x to the right of +z."""

    texels: Any  # as in `minirt.kernel.shading.texturing`
    pictures: Any  # its only row


def lit_sky(scene: Traced, hit: Mask, light: Vec, direction: Vec) -> Vec:
    """The light of rays that hit, and of the sky for those that do not."""
    if scene.sky is not None:
        light = where(hit, light, Vec(scene.sky[0], scene.sky[1], scene.sky[2]))
    if scene.dome is not None and any(~hit):
        light = where(hit, light, painted(scene.dome, direction))
    return light


def beyond(scene: Traced, weight: Number, direction: Vec) -> Vec:
    """The light of the sky in a direction, times a weight."""
    nothing = splat(0.0, weight)
    dark = Vec(nothing, nothing, nothing)
    return where(weight > 0.0, weight * lit_sky(scene, weight < 0.0, dark, direction), dark)


def painted(dome: Dome, direction: Vec) -> Vec:
    """The light of a picture around the scene."""
    u, v = longitude_and_latitude(direction)
    edge = 0.5 / dome.pictures[0, 2]  # nothing is above the upper row of pixels
    return picture_at(dome.texels, dome.pictures, 0, u, minimum(maximum(v, edge), 1.0 - edge))


def longitude_and_latitude(direction: Vec) -> tuple[Number, Number]:
    """Where a direction is in such a picture: from 0 to 1 from left to right and from below to above."""
    u = 0.5 + arctan2(-direction.x, direction.z) * (0.5 / pi)
    v = 0.5 + arctan2(direction.y, sqrt(direction.x * direction.x + direction.z * direction.z)) * (1.0 / pi)
    return u, v
