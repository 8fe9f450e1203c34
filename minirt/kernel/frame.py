"""A frame: the rays of the camera through every pixel, and the picture that they bring back."""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.atomic_counter import fetch_add
from minirt.kernel.scene_arrays import SceneArrays, by_reference
from minirt.kernel.shading.environment import background_light
from minirt.kernel.shading.whitted import radiance
from minirt.kernel.trace import is_empty
from minirt.lanes import Vec, lane, load, minimum, rarely, save, splat, unit, where, width
from minirt.lanes.vec import Number

DOWN = 4  # pixels of a packet, from top to bottom; as many from left to right as make one of `width` rays
TILE = 16  # pixels along an edge of a tile: a thread takes a row of tiles at a time
CANCELLED = 2**40  # a row that no picture has
OPAQUE = 0xFF000000  # alpha of a pixel


def ray_direction(camera: Any, x: float, y: float) -> Vec:
    """The direction of the ray through a place of the picture, in pixels from its upper left corner; of any length."""
    corner = Vec(camera[3], camera[4], camera[5])
    return corner + x * Vec(camera[6], camera[7], camera[8]) + y * Vec(camera[9], camera[10], camera[11])


def packet_radiance(scene: SceneArrays, memory: Any, tile: int, rays: Any, x: int, y: int) -> Vec:
    """The light of the pixels of a packet whose upper left one is x, y, along the `rays` of a sample."""
    count = width(rays)
    origin = Vec(scene.camera[0], scene.camera[1], scene.camera[2])
    direction = ray_direction(scene.camera, x, y) + Vec(load(rays, 0), load(rays, count), load(rays, 2 * count))
    return radiance(scene, memory, tile, origin, unit(direction))


def accumulate(light: Vec, sums: Any, start: int, sample: int) -> Vec:
    """The light of a sample and of those before it, whose sum is kept in `sums` from index `start` on."""
    count = width(sums)
    if sample > 0:
        light = light + Vec(load(sums, start), load(sums, start + count), load(sums, start + 2 * count))
    save(light.x, sums, start)
    save(light.y, sums, start + count)
    save(light.z, sums, start + 2 * count)
    return light


def without_non_finite(light: Vec, memory: Any) -> Vec:
    """The light, which is not negative, without components that are infinite or NaN. The rays that have such are added
    up in the last row of `memory`."""
    total = light.x + light.y + light.z
    if rarely(~(total < inf)):
        for i in range(width(total)):
            if not lane(total, i) < inf:
                memory[memory.shape[0] - 1, 1] += 1.0
        light = Vec(finite_or_zero(light.x), finite_or_zero(light.y), finite_or_zero(light.z))
    return light


def finite_or_zero(light: Number) -> Number:
    """Light as it is, or 0 for infinity and NaN."""
    return where(light < inf, light, 0.0)


def to_byte_range(light: Number) -> Number:
    """Light, which is not negative, as a byte, still to be cut to a whole number; what is above 1 is clamped."""
    return minimum(light, 1.0) * 255.0 + 0.5


def frame(
    next_row: Any, pixels: Any, linear: Any, rays: Any, wanted: Any, memory: Any, sums: Any, scene: SceneArrays
) -> None:
    """Render rows of tiles, taking the next one from the counter `next_row` until none is left.

    Any number of threads may do so at the same time, each with a `memory` (see `trace`) and room for the `sums` of
    samples of a tile (3 * TILE * TILE) of its own. `pixels` (h, w) takes 0xAARRGGBB; `linear` (h, w, 3), or one without
    rows where it is not wanted, takes the light as it is. `rays` (k, 3 * width) are the directions of a packet's rays
    for each sample of a pixel: x, y and z of their differences from the one through the upper left corner of the
    packet. `wanted` is not 0 for each packet (row, column) that is to be rendered, or has no rows where all are. A
    counter set to `CANCELLED` from outside ends the frame at the next packet.
    """
    render_tiles(
        next_row,
        by_reference(pixels),
        by_reference(linear),
        rays,
        by_reference(wanted),
        by_reference(memory),
        sums,
        by_reference(scene),
    )


def render_tiles(
    next_row: Any, pixels: Any, linear: Any, rays: Any, wanted: Any, memory: Any, sums: Any, scene: SceneArrays
) -> None:
    """The frame, tile by tile."""
    height, across = pixels.shape
    samples = rays.shape[0]
    step = width(rays) // DOWN
    nothing = splat(0.0, load(rays[0], 0))
    dark = Vec(nothing, nothing, nothing)
    while True:
        top = fetch_add(next_row, TILE)
        if top >= height:
            return
        for left in range(0, across, TILE):
            tile = top // TILE * tile_count(across) + left // TILE
            empty = scene.environment is None and is_empty(scene, tile)
            # All packets for each sample, not all samples for each packet: a sum that is kept through the loop takes
            # registers from what is in it, and a seventh more time.
            for sample in range(samples):
                for y in range(top, min(top + TILE, height), DOWN):
                    for x in range(left, min(left + TILE, across), step):
                        if rarely(next_row[0] >= CANCELLED):
                            return
                        if rarely(wanted.shape[0] > 0) and wanted[y // DOWN, x // step] == 0:
                            continue
                        if empty:
                            store_packet(pixels, linear, x, y, background_light(scene, nothing > 0.0, dark, dark))
                            continue
                        light = without_non_finite(packet_radiance(scene, memory, tile, rays[sample], x, y), memory)
                        if rarely(samples > 1):
                            place = (y - top) * TILE + (x - left) * DOWN
                            light = accumulate(light, sums, 3 * place, sample) / samples
                        if sample == samples - 1:
                            store_packet(pixels, linear, x, y, light)


def tile_count(pixels: int) -> int:
    """Tiles that it takes to cover so many pixels."""
    return (pixels + TILE - 1) // TILE


def store_packet(pixels: Any, linear: Any, x: int, y: int, light: Vec) -> None:
    """Put the light of a packet into the picture; what lies beyond its edges is dropped."""
    height, across = pixels.shape
    keep = linear.shape[0] > 0
    step = width(light.x) // DOWN
    red, green, blue = to_byte_range(light.x), to_byte_range(light.y), to_byte_range(light.z)
    if rarely(keep or x + step > across or y + DOWN > height):
        for i in range(width(light.x)):
            column, line = x + i % step, y + i // step
            if column < across and line < height:
                pixels[line, column] = argb(lane(red, i), lane(green, i), lane(blue, i))
                if keep:
                    linear[line, column, 0] = lane(light.x, i)
                    linear[line, column, 1] = lane(light.y, i)
                    linear[line, column, 2] = lane(light.z, i)
    else:
        store_block(pixels, x, y, red, green, blue)


def argb(red: float, green: float, blue: float) -> int:
    """A pixel from its levels."""
    return OPAQUE | int(red) << 16 | int(green) << 8 | int(blue)


def store_block(pixels: Any, x: int, y: int, red: Number, green: Number, blue: Number) -> None:
    """Put a whole packet into the picture; compiled, a row of it at a time."""
    step = width(red) // DOWN
    for i in range(width(red)):
        pixels[y + i // step, x + i % step] = argb(lane(red, i), lane(green, i), lane(blue, i))
