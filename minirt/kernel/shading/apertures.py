"""Samples of a lens and of light sources with a size: each ray of a packet has an eye and points of lights of its own.

In scenes that have any, a row of `rays` of `minirt.kernel.frame` has eight numbers for each ray of a packet: its
direction, the offset of its eye in the scene, and x and y of a point in the unit disc, which serves all lights. Each
light turns the disc about its centre by an angle of its own.

A light of radius r at c is the disc about c that faces the point p that it lights. Its sample is c + r o. A shape that
lies between p and the sample, moved by -r o or less, lies between p and c: culling from c, by directions from p to c,
holds for all samples where shapes are grown by r (see `minirt.rendering.culling.visibility`).
"""

from __future__ import annotations

from typing import Any

from minirt.kernel.scene_arrays import SceneArrays, has_rows
from minirt.lanes import Number, Vec, copysign, dot, inverse_root, load, save, splat, width

NUMBERS = 8  # for each ray of a packet, in a row of `rays`
EYE, DISC = 3, 6  # the first of those of the eye and of the disc
KEPT = 4  # column of the last row of `memory` from which the points in the disc are


def sampled_eye(scene: SceneArrays, rays: Any) -> Vec:
    """Return the eye of each ray of a packet: a point of the lens."""
    like, count = load(rays, 0), width(rays)
    eye = Vec(splat(scene.camera[0], like), splat(scene.camera[1], like), splat(scene.camera[2], like))
    if has_rows(scene.lens):
        first = EYE * count
        eye = eye + Vec(load(rays, first), load(rays, first + count), load(rays, first + 2 * count))
    return eye


def remember_sample(scene: SceneArrays, memory: Any, rays: Any) -> None:
    """Keep the points in the disc of a packet's rays in `memory`, where the shading of all its hits finds them."""
    if has_rows(scene.soft):
        count, row = width(rays), memory[memory.shape[0] - 1]
        save(load(rays, DISC * count), row, KEPT)
        save(load(rays, (DISC + 1) * count), row, KEPT + count)


def sampled_position(
    soft: Any, memory: Any, light: int, position: Vec, to_light: Vec, distance: Number
) -> tuple[Vec, Vec, Number]:
    """Return the sampled position of a light source for each ray, the direction towards it, and its distance.

    Given are those of its centre. `soft` (m, 4) has for each light: its radius; the tangent of half its angular
    diameter, for parallel light; and cosine and sine of the angle by which it turns the disc.
    """
    position = Vec(splat(position.x, distance), splat(position.y, distance), splat(position.z, distance))
    if has_rows(soft):
        row = memory[memory.shape[0] - 1]
        x, y = load(row, KEPT), load(row, KEPT + width(distance))
        across, down = perpendicular(to_light)
        cosine, sine = soft[light, 2], soft[light, 3]
        offset = (cosine * x - sine * y) * across + (sine * x + cosine * y) * down
        towards = to_light + (soft[light, 0] / distance + soft[light, 1]) * offset
        squared = dot(towards, towards)
        per_length = inverse_root(squared)
        position = position + soft[light, 0] * offset
        to_light = towards * per_length
        distance = distance * (squared * per_length)
    return position, to_light, distance


def perpendicular(axis: Vec) -> tuple[Vec, Vec]:
    """Return two unit vectors that are perpendicular to a unit vector and to each other (Duff et al., Building an
    orthonormal basis, revisited, 2017)."""
    sign = copysign(1.0, axis.z)
    a = -1.0 / (sign + axis.z)
    b = axis.x * axis.y * a
    return (
        Vec(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x),
        Vec(b, sign + axis.y * axis.y * a, -axis.y),
    )
