"""Rendering of a frame: primary rays through every pixel, in packets, tile by tile, and their colours as pixels."""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.atomic_counter import fetch_add
from minirt.kernel.scene_arrays import SceneArrays, by_reference
from minirt.kernel.shading.environment import background_light, has_environment
from minirt.kernel.shading.whitted import incoming_radiance
from minirt.kernel.trace import is_empty
from minirt.lanes import Vec, lane, load, minimum, rarely, save, splat, unit, where, width
from minirt.lanes.vec import Number

PACKET_HEIGHT = 4  # pixels; a packet is as wide as makes one pixel for each of the `width` rays
# Samples of a reference by those of what is drawn. The error of an estimate of the error is that of four times as many
# references with as many samples, at twice the cost of one.
REFERENCE_SAMPLES = 2
TILE = 16  # pixels along an edge of a tile: a thread takes a row of tiles, or so many rows of a plan, at a time
SUMS = 3 * TILE * TILE  # numbers of a tile's light
ESTIMATE = SUMS // 4  # those after which the light of the next estimate of a planned packet is kept
CANCELLED = 2**40  # value of the row counter that cancels a frame; no picture has so many rows
OPAQUE = 0xFF000000  # alpha of a pixel


def ray_direction(camera: Any, x: float, y: float) -> Vec:
    """Return the direction, not normalised, of the primary ray at x, y: pixels from the picture's upper left corner."""
    corner = Vec(camera[3], camera[4], camera[5])
    return corner + x * Vec(camera[6], camera[7], camera[8]) + y * Vec(camera[9], camera[10], camera[11])


def packet_radiance(scene: SceneArrays, memory: Any, tile: int, rays: Any, x: int, y: int) -> Vec:
    """Trace one sample of each pixel of the packet whose upper left pixel is x, y; `rays` are the sample's offsets."""
    count = width(rays)
    origin = Vec(scene.camera[0], scene.camera[1], scene.camera[2])
    direction = ray_direction(scene.camera, x, y) + Vec(load(rays, 0), load(rays, count), load(rays, 2 * count))
    return incoming_radiance(scene, memory, tile, origin, unit(direction))


def accumulate(radiance: Vec, sums: Any, start: int, sample: int) -> Vec:
    """Add the radiance of a sample to that of the samples before it, which `sums` holds from index `start` on."""
    count = width(sums)
    if sample > 0:
        radiance = radiance + Vec(load(sums, start), load(sums, start + count), load(sums, start + 2 * count))
    save_sum(radiance, sums, start)
    return radiance


def save_sum(radiance: Vec, sums: Any, start: int) -> None:
    """Store a radiance in `sums` from index `start` on."""
    count = width(sums)
    save(radiance.x, sums, start)
    save(radiance.y, sums, start + count)
    save(radiance.z, sums, start + 2 * count)


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


def to_byte_range(channel: Number) -> Number:
    """Clamp a colour channel, which is not negative, to 1 and scale it so that truncation rounds it to a byte."""
    return minimum(channel, 1.0) * 255.0 + 0.5


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

    Any number of threads may do so at the same time, each with its own `memory` (see `minirt.kernel.trace.unoccluded`
    and `minirt.kernel.shading.surfaces`) and its own `sums` of samples of a tile (`SUMS` numbers). `pixels`
    (h, w) receives 0xAARRGGBB; `linear` (h, w, 3) receives the unclamped radiance, unless it has no rows. `rays` (rows,
    3 * width) has x, y and z of the directions of a packet's rays, less the direction through the packet's upper left
    corner. `plan` (k, 5) has for each packet to draw its column and row among the packets, its first row in `rays`, its
    number of samples, and the first row of two reference estimates, each of `REFERENCE_SAMPLES` times as many samples,
    0 for none. Without rows all packets take all rows of `rays`. `errors` (k,) receives the squared errors of packets
    with references, see `squared_error`. A counter set to
    `CANCELLED` from outside ends the frame at the next packet.
    """
    render_tiles(
        next_row,
        by_reference(pixels),
        by_reference(linear),
        rays,
        by_reference(plan),
        by_reference(errors),
        by_reference(memory),
        sums,
        by_reference(scene),
    )


def render_tiles(
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
    """Render rows of tiles: the body of `frame`, with the arrays passed by reference."""
    height, across = pixels.shape
    packet_width = width(rays) // PACKET_HEIGHT
    columns = TILE // packet_width
    packets = columns * TILE // PACKET_HEIGHT  # of a tile
    zero = splat(0.0, load(rays[0], 0))
    black = Vec(zero, zero, zero)
    is_planned = rarely(plan.shape[0] > 0)
    end = plan.shape[0] if is_planned else height
    while True:
        top = fetch_add(next_row, TILE)
        if top >= end:
            return
        for left in range(0, 1 if is_planned else across, TILE):
            tile = tile_at(left, top, across)
            empty = not has_environment(scene) and is_empty(scene, tile)
            # All packets for each sample, not all samples for each packet: a sum kept in registers through the loop
            # over samples took a seventh more time, since tracing then lacks those registers. Planned packets, each in
            # any tile, take all of their samples one after the other.
            for outer in range(min(TILE, end - top) if is_planned else rays.shape[0]):
                inners, item = packets, -1
                if is_planned:
                    item = top + outer
                    inners = planned_rays(plan, item)
                    tile = tile_at(plan[item, 0] * packet_width, plan[item, 1] * PACKET_HEIGHT, across)
                    empty = not has_environment(scene) and is_empty(scene, tile)
                for inner in range(inners):
                    y, x = top + inner // columns * PACKET_HEIGHT, left + inner % columns * packet_width
                    estimate, row, sample, samples, place = 0, outer, outer, rays.shape[0], 3 * inner * width(rays)
                    if is_planned:
                        y, x = plan[item, 1] * PACKET_HEIGHT, plan[item, 0] * packet_width
                        estimate, row, sample, samples = planned(plan, item, inner)
                        place = estimate * ESTIMATE
                    if y >= height or x >= across:
                        continue
                    if rarely(next_row[0] >= CANCELLED):
                        return
                    if empty:
                        store_packet(pixels, linear, x, y, background_light(scene, zero > 0.0, black, black))
                        continue
                    radiance = without_non_finite(packet_radiance(scene, memory, tile, rays[row], x, y), memory)
                    if rarely(samples > 1):
                        radiance = accumulate(radiance, sums, place, sample) / samples
                    if sample == samples - 1:
                        store_estimate(
                            pixels, linear, errors, sums, x, y, radiance, estimate, item if is_planned else -1
                        )


def tile_at(x: int, y: int, across: int) -> int:
    """Return the number of the tile with a pixel, in a picture of so many pixels across."""
    return y // TILE * tile_count(across) + x // TILE


def planned_rays(plan: Any, item: int) -> int:
    """Return the number of rays that each pixel of a packet takes by plan."""
    references = 0 if plan[item, 4] == 0 else 2 * REFERENCE_SAMPLES
    return int(plan[item, 3] * (1 + references))


def planned(plan: Any, item: int, turn: int) -> tuple[int, int, int, int]:
    """Return what a packet takes when a pixel has taken `turn` rays before: the number of the estimate, the row of
    `rays`, the number of the sample in that estimate, and the number of its samples."""
    first, samples, reference = plan[item, 2], plan[item, 3], plan[item, 4]
    if turn < samples:
        return 0, first + turn, turn, samples
    each, turn = REFERENCE_SAMPLES * samples, turn - samples
    estimate = turn // each
    return 1 + estimate, reference + turn, turn - estimate * each, each


def store_estimate(
    pixels: Any, linear: Any, errors: Any, sums: Any, x: int, y: int, radiance: Vec, estimate: int, item: int
) -> None:
    """Store the radiance of a packet in the picture, and where references tell its squared error, that error. `item` is
    the packet's row in the plan; negative without a plan."""
    if estimate == 0:
        store_packet(pixels, linear, x, y, radiance)
    if rarely(item >= 0):
        save_sum(radiance, sums, estimate * ESTIMATE)
        if estimate == 2:
            errors[item] = squared_error(sums, pixels.shape[0] - y, pixels.shape[1] - x, width(radiance.x))


def squared_error(sums: Any, height: int, across: int, count: int) -> float:
    """Estimate the squared error of a packet's light, clamped to [0, 1], summed over its `count` pixels and channels.

    `sums` has the light and two reference estimates. Where the references are independent and have
    no bias, the product of the differences from each of them has the squared error as its mean, however large their own
    errors are. Of the packet's pixels, those beyond `height` lines or `across` columns are left out.
    """
    packet_width = count // PACKET_HEIGHT
    total = 0.0
    for number in range(3 * count):
        pixel = number % count
        if pixel // packet_width < height and pixel % packet_width < across:
            light = min(sums[number], 1.0)
            one, other = min(sums[ESTIMATE + number], 1.0), min(sums[2 * ESTIMATE + number], 1.0)
            total += (light - one) * (light - other)
    return total


def tile_count(pixels: int) -> int:
    """Return the number of tiles that cover a picture of so many pixels along one edge."""
    return (pixels + TILE - 1) // TILE


def store_packet(pixels: Any, linear: Any, x: int, y: int, radiance: Vec) -> None:
    """Store the radiance of a packet in the picture, except for pixels beyond the picture's edges."""
    height, across = pixels.shape
    has_linear = linear.shape[0] > 0
    packet_width = width(radiance.x) // PACKET_HEIGHT
    red, green, blue = to_byte_range(radiance.x), to_byte_range(radiance.y), to_byte_range(radiance.z)
    if rarely(has_linear or x + packet_width > across or y + PACKET_HEIGHT > height):
        for i in range(width(radiance.x)):
            column, row = x + i % packet_width, y + i // packet_width
            if column < across and row < height:
                pixels[row, column] = argb(lane(red, i), lane(green, i), lane(blue, i))
                if has_linear:
                    linear[row, column, 0] = lane(radiance.x, i)
                    linear[row, column, 1] = lane(radiance.y, i)
                    linear[row, column, 2] = lane(radiance.z, i)
    else:
        store_block(pixels, x, y, red, green, blue)


def argb(red: float, green: float, blue: float) -> int:
    """Return an opaque pixel, 0xAARRGGBB, whose channels are truncated to bytes."""
    return OPAQUE | int(red) << 16 | int(green) << 8 | int(blue)


def store_block(pixels: Any, x: int, y: int, red: Number, green: Number, blue: Number) -> None:
    """Store a packet that lies wholly in the picture; compiled, each of its rows is one store."""
    packet_width = width(red) // PACKET_HEIGHT
    for i in range(width(red)):
        pixels[y + i // packet_width, x + i % packet_width] = argb(lane(red, i), lane(green, i), lane(blue, i))
