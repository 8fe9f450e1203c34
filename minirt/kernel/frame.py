"""Rendering of a frame: primary rays through every pixel, in packets, tile by tile, and their colours as pixels."""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.pixels import (
    LAST,
    PACKET_HEIGHT,
    TILE,
    LightSums,
    add_to_pixels,
    fetch_add,
    store_estimate,
    store_packet,
)
from minirt.kernel.scene_arrays import SceneArrays, vector
from minirt.kernel.shading.lights import parts_of_lights, remember_part, remember_sample, sampled_eye
from minirt.kernel.shading.patterns import remember_spacing
from minirt.kernel.shading.texturing import background_light, has_environment
from minirt.kernel.shading.whitted import incoming_radiance
from minirt.kernel.trace import is_empty
from minirt.lanes import Number, Vec, lane, load, load_vec, rarely, splat, unit, where, width

CANCELLED = 2**40  # value of the row counter that cancels a frame; no picture has so many rows


def ray_direction(camera: Any, x: float, y: float) -> Vec:
    """Return the direction, not normalised, of the primary ray at x, y: pixels from the picture's upper left corner."""
    return vector(camera, 3) + x * vector(camera, 6) + y * vector(camera, 9)


def packet_radiance(scene: SceneArrays, memory: Any, tile: int, rays: Any, x: int, y: int) -> Vec:
    """Trace rays of the packet of pixels whose upper left one is x, y; `rays` are their offsets."""
    origin = vector(scene.camera, 0)
    if scene.lens is not None:
        origin = sampled_eye(scene, rays)
    if scene.soft is not None:
        remember_sample(scene, memory, rays)
    corner = ray_direction(scene.camera, x + scene.camera[12], y + scene.camera[13])
    direction = corner + load_vec(rays, 0)
    return incoming_radiance(scene, memory, tile, origin, unit(direction))


def mean_radiance(
    next_row: Any, scene: SceneArrays, memory: Any, tile: int, rays: Any, row: int, x: int, y: int, light: LightSums
) -> Vec:
    """Return the mean radiance of each pixel of a packet: of all its samples, and the parts of light sources so far.

    The upper left pixel is x, y. The rays of the samples are in `rays` from `row` on. `light.sums` receives the sums
    where there is more than one sample or part. The counter `next_row` may cancel the frame: then the result is of no
    use.
    """
    zero = splat(0.0, load(rays[0], 0))
    radiance = Vec(zero, zero, zero)
    for turn in range(light.samples):
        if rarely(next_row[0] >= CANCELLED):
            break
        radiance = packet_radiance(scene, memory, tile, rays[row + turn], x, y)
        radiance = without_non_finite(radiance, memory)
        if rarely(light.samples * light.parts > 1):
            add_to_pixels(radiance, light, turn)
    if rarely(light.samples * light.parts > 1):
        radiance = load_vec(light.sums, light.place) / (light.samples * light.parts)
    return radiance


def without_non_finite(radiance: Vec, memory: Any) -> Vec:
    """Replace infinite and NaN components of a radiance, which is not negative, by 0.

    The last row of `memory` counts the rays that had any.
    """
    total = radiance.x + radiance.y + radiance.z
    if rarely(~(total < inf)):
        for i in range(width(total)):
            if not lane(total, i) < inf:
                memory[memory.shape[0] - 1, 1] += 1.0
        radiance = Vec(finite_or_zero(radiance.x), finite_or_zero(radiance.y), finite_or_zero(radiance.z))
    return radiance


def finite_or_zero(channel: Number) -> Number:
    """Return a colour channel, or 0 in place of infinity and NaN."""
    return where(channel < inf, channel, 0.0)


def frame(
    next_row: Any,
    pixels: Any,
    linear: Any,
    rays: Any,
    plan: Any,
    errors: Any,
    memory: Any,
    sums: Any,
    scene: SceneArrays,
) -> None:
    """Render rows of tiles, or rows of a plan, taking the next ones from the counter `next_row` until none is left.

    Any number of threads may do so at the same time, each with its own `memory` and `sums`. A counter set to
    `CANCELLED` from outside ends the frame at the next packet.

    - `pixels` (h, w) receives 0xAARRGGBB.
    - `linear` (h, w, 3) receives the unclamped radiance, unless it has no rows.
    - `rays` (rows, 3 * width) has x, y and z of the directions of rays, less the direction through the upper left
      corner of their packet. Where the scene has a lens or light sources with a size it is longer, see
      `minirt.kernel.shading.lights`. The samples of a pixel follow each other: traced together they meet the same
      shapes more often than those of neighbours.
    - `plan` (k, 5) has for each packet to draw its column and row among the packets, its first row in `rays`, its
      number of samples, and the first row of two reference estimates, each of as many samples, 0 for none. Without
      rows all packets take all rows of `rays`.
    - `errors` (k,) receives the squared errors of packets with references, see `squared_error`.
    - `memory` (m + 1, ...) caches cells of m light sources, see `minirt.kernel.shadow_rays.unoccluded`; its last row
      holds numbers of the packet, see `minirt.kernel.shading.lights`.
    - `sums` (`SUMS`,) is memory for the samples of a tile.
    """
    height, across = pixels.shape
    count = width(rays)
    packet_width = count // PACKET_HEIGHT
    columns = TILE // packet_width
    zero = splat(0.0, load(rays[0], 0))
    black = Vec(zero, zero, zero)
    is_planned = rarely(plan.shape[0] > 0)
    parts = parts_of_lights(scene)
    has_squares = scene.square < TILE  # in a crowd of shapes: smaller squares of a tile have lists of their own
    end = plan.shape[0] if is_planned else height
    estimates = 3 if is_planned else 1  # of a packet: its own and those of two references
    while True:
        top = fetch_add(next_row, TILE)
        if top >= end:
            return
        packets = min(TILE, end - top) if is_planned else columns * TILE // PACKET_HEIGHT
        for left in range(0, 1 if is_planned else across, TILE):
            tile = tile_at(scene, left, 0 if is_planned else top, across)
            empty = not has_environment(scene) and is_empty(scene, tile)
            for number in range(parts * packets * estimates):
                turn, estimate = number // estimates, number % estimates
                part, packet = turn // packets, turn % packets
                item, row, samples = -1, 0, rays.shape[0]
                y, x = top + packet // columns * PACKET_HEIGHT, left + packet % columns * packet_width
                if is_planned:
                    item = top + packet
                    y, x = plan[item, 1] * PACKET_HEIGHT, plan[item, 0] * packet_width
                    row, samples = planned(plan, item, estimate)
                if y >= height or x >= across or samples == 0:
                    continue
                if rarely(has_squares or is_planned):
                    tile = tile_at(scene, x, y, across)
                    empty = not has_environment(scene) and is_empty(scene, tile)
                if empty:
                    no_hit = zero > 0.0
                    radiance = background_light(scene, no_hit, black, black)  # alike in all directions
                    store_packet(pixels, linear, sums, LAST, x, y, radiance)
                    continue
                remember_part(scene, memory, part, parts)
                remember_spacing(scene, memory, samples, estimate)
                place = (3 * packet + estimate) * 3 * count  # three estimates of a packet, three colours of an estimate
                light = LightSums(sums, place, samples, part, parts)
                radiance = mean_radiance(next_row, scene, memory, tile, rays, row, x, y, light)
                if rarely(next_row[0] >= CANCELLED):
                    return
                if part == parts - 1:
                    store_estimate(pixels, linear, errors, light, x, y, radiance, item, estimate)


def tile_at(scene: SceneArrays, x: int, y: int, across: int) -> int:
    """Return the number of the tile with a pixel, in a picture of so many pixels across, or of the square in it."""
    return y // scene.square * tile_count(across, scene.square) + x // scene.square


def planned(plan: Any, item: int, estimate: int) -> tuple[int, int]:
    """Return the first row in `rays` of an estimate of a packet, and its number of samples, which is 0 where the plan
    has no references."""
    first, samples, reference = plan[item, 2], plan[item, 3], plan[item, 4]
    if estimate == 0:
        return int(first), int(samples)
    return int(reference + (estimate - 1) * samples), int(samples if reference > 0 else 0)


def tile_count(pixels: int, square: int = TILE) -> int:
    """Return the number of tiles, or of smaller squares, that cover a picture of so many pixels along one edge."""
    return (pixels + square - 1) // square
