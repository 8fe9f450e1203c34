"""Pixels of a picture: the light of packets, summed over samples and stored, and the contrast of what is stored."""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.lanes import Number, Vec, lane, minimum, rarely, save_vec, splat, width

PACKET_HEIGHT = 4  # pixels; a packet is as wide as makes one pixel for each of the `width` rays
TILE = 16  # pixels along an edge of a tile: a thread takes a row of tiles, or so many rows of a plan, at a time
WIDEST = 32  # rays of a packet, at most
LAST = 3 * 3 * TILE * WIDEST  # place of the last rays' light in sums: behind `TILE` packets of three estimates each
SUMS = LAST + 3 * WIDEST  # numbers of all these
OPAQUE = 0xFF000000  # alpha of a pixel
CHANNELS = 4  # bytes of a pixel


def fetch_add(counter: Any, amount: int) -> int:
    """Add to a counter that threads share, and return its value from before; compiled, this is atomic."""
    before = int(counter[0])
    counter[0] += amount
    return before


class LightSums(NamedTuple):
    """The light of a packet of pixels while its samples are added up."""

    sums: Any  # of many packets
    place: int  # of this one in `sums`: red of all its pixels, then green, then blue
    samples: int  # of a pixel
    part: int  # of the light sources, of some `parts`, that shines
    parts: int


def add_to_pixels(radiance: Vec, light: LightSums, turn: int) -> None:
    """Add the radiance of the rays of one `turn` to the sums of their pixels, in `light.sums`.

    Each turn traces `width` samples of a packet. The samples of the packet are in the order of its pixels, those of a
    pixel one after the other. The first turn of the first part sets the sums to 0. `light.sums` is overwritten from
    `LAST` on.
    """
    sums, place, samples = light.sums, light.place, light.samples
    zero, count = splat(0.0, radiance.x), width(radiance.x)
    if turn == 0 and light.part == 0:
        save_vec(Vec(zero, zero, zero), sums, place)
    save_vec(radiance, sums, LAST)
    pixel = turn * count // samples
    begin, end = 0, (pixel + 1) * samples - turn * count  # the range of that pixel's rays, up to its last sample
    while begin < count:
        end = min(end, count)
        red, green, blue = sums[place + pixel], sums[place + count + pixel], sums[place + 2 * count + pixel]
        for i in range(LAST + begin, LAST + end):
            red, green, blue = red + sums[i], green + sums[i + count], blue + sums[i + 2 * count]
        sums[place + pixel], sums[place + count + pixel], sums[place + 2 * count + pixel] = red, green, blue
        pixel, begin, end = pixel + 1, end, end + samples


def to_byte_range(channel: Number) -> Number:
    """Clamp a colour channel, which is not negative, to 1 and scale it so that truncation rounds it to a byte."""
    return minimum(channel, 1.0) * 255.0 + 0.5


def store_estimate(
    pixels: Any, linear: Any, errors: Any, light: LightSums, x: int, y: int, radiance: Vec, item: int, estimate: int
) -> None:
    """Store the radiance of a packet, or in its place in the sums that of an `estimate`, of which the first, 0, is the
    packet's. Where two references tell its squared error, store that for the packet's row in the plan, `item`."""
    sums, place, count = light.sums, light.place, width(radiance.x)
    if estimate == 0:
        store_packet(pixels, linear, sums, LAST, x, y, radiance)
    if rarely(item >= 0):
        save_vec(radiance, sums, place)
        if estimate == 2:
            errors[item] = squared_error(sums, place - 6 * count, pixels.shape[0] - y, pixels.shape[1] - x, count)


def squared_error(sums: Any, place: int, height: int, across: int, count: int) -> float:
    """Estimate the squared error of a packet's light, clamped to [0, 1], summed over its `count` pixels and channels.

    `sums` has from `place` on the light and two reference estimates, each 3 * `count` numbers. Where the references
    are independent and have no bias, the product of the differences from each of them has the squared error as its
    mean, however large their own errors are. Of the packet's pixels, those beyond `height` lines or `across` columns
    are left out.
    """
    packet_width = count // PACKET_HEIGHT
    total = 0.0
    for number in range(3 * count):
        pixel = number % count
        if pixel // packet_width < height and pixel % packet_width < across:
            at = place + number
            light, one, other = min(sums[at], 1.0), min(sums[at + 3 * count], 1.0), min(sums[at + 6 * count], 1.0)
            total += (light - one) * (light - other)
    return total


def store_packet(pixels: Any, linear: Any, sums: Any, place: int, x: int, y: int, radiance: Vec) -> None:
    """Store the radiance of a packet whose upper left pixel is (x, y), except for pixels beyond the edges.

    `pixels` (h, w) are 0xAARRGGBB, `linear` is (h, w, 3), or has no rows where no light is wanted. The numbers of
    `sums` from `place` on may be overwritten.
    """
    height, across = pixels.shape
    has_linear = linear.shape[0] > 0
    count = width(radiance.x)
    red, green, blue = to_byte_range(radiance.x), to_byte_range(radiance.y), to_byte_range(radiance.z)
    is_whole = x + count // PACKET_HEIGHT <= across and y + PACKET_HEIGHT <= height
    if is_whole:
        store_block(pixels, x, y, red, green, blue)
    if rarely(has_linear or not is_whole):
        save_vec(radiance, sums, place)
        for i in range(count):
            column, row = x + i % (count // PACKET_HEIGHT), y + i // (count // PACKET_HEIGHT)
            if column < across and row < height:
                if not is_whole:
                    pixels[row, column] = argb(lane(red, i), lane(green, i), lane(blue, i))
                if has_linear:
                    for channel in range(3):
                        linear[row, column, channel] = sums[place + channel * count + i]


def argb(red: float, green: float, blue: float) -> int:
    """Return an opaque pixel, 0xAARRGGBB, whose channels are truncated to bytes."""
    return OPAQUE | int(red) << 16 | int(green) << 8 | int(blue)


def store_block(pixels: Any, x: int, y: int, red: Number, green: Number, blue: Number) -> None:
    """Store a packet that lies wholly in the picture; compiled, each of its rows is one store."""
    packet_width = width(red) // PACKET_HEIGHT
    for i in range(width(red)):
        pixels[y + i // packet_width, x + i % packet_width] = argb(lane(red, i), lane(green, i), lane(blue, i))


def copy_levels(next_line: Any, pixels: Any, levels: Any) -> None:
    """Copy red, green and blue of pixels, (h, 4 w) bytes in the order blue, green, red, alpha, into `levels`, (h, 3 w).

    Any number of threads may do so at the same time, claiming lines from a counter until none is left.
    """
    while True:
        top = fetch_add(next_line, TILE)
        if top >= levels.shape[0]:
            return
        for y in range(top, min(top + TILE, levels.shape[0])):
            line, into = pixels[y], levels[y]
            for x in range(levels.shape[1] // 3):
                into[3 * x], into[3 * x + 1], into[3 * x + 2] = line[4 * x + 2], line[4 * x + 1], line[4 * x]


def classify(next_row: Any, lines: Any, differences: Any, words: Any, class_of: Any, classes: Any) -> None:
    """Find the contrast classes of rows of packets, taking the next one from the counter `next_row` until none is left.

    Any number of threads may do so at the same time, each with its own `differences` and `words`. `lines` are the bytes
    of a picture that consists of whole packets, (lines, bytes). `classes` (rows, columns) receives the class of each
    packet. It belongs to the greatest difference of a byte from that of a neighbour above, below, left or right:
    `class_of` (256,) has the class for all bits of such differences. `differences` (2, bytes) is overwritten; the
    uint64 `words` (2, bytes / 8) are the same memory.
    """
    height = lines.shape[0]
    rows, columns = classes.shape
    packet_words = words.shape[1] // columns  # of a packet: each holds the differences of two pixels
    while True:
        row = fetch_add(next_row, 1)
        if row >= rows:
            return
        y = row * PACKET_HEIGHT
        above, below = lines[max(y - 1, 0)], lines[min(y + PACKET_HEIGHT, height - 1)]
        packet = lines[y], lines[y + 1], lines[y + 2], lines[y + 3]
        differences_upright(above, packet, below, differences[0], lines.shape[1])
        differences_beside(packet, differences[1], lines.shape[1])
        for column in range(columns):
            # The upper half: the last pixel of the packet before differs from the first of this one.
            bits = words[1, max(column * packet_words - 1, 0)] >> 32
            for i in range(column * packet_words, (column + 1) * packet_words):
                bits |= words[0, i] | words[1, i]
            # All bytes of the word into its lowest one. The highest bit of all differences is that of the greatest.
            bits |= bits >> 32
            bits |= bits >> 16
            bits |= bits >> 8
            classes[row, column] = class_of[bits & 255]


def differences_upright(above: Any, packet: tuple[Any, ...], below: Any, bits: Any, size: int) -> None:
    """Write into `bits` those of the differences of the four lines of a row of packets from those above and below."""
    a, b, c, d = packet
    for i in range(size):
        inner = difference(a[i], b[i]) | difference(b[i], c[i]) | difference(c[i], d[i])
        bits[i] = difference(above[i], a[i]) | inner | difference(d[i], below[i])


def differences_beside(packet: tuple[Any, ...], bits: Any, size: int) -> None:
    """Write into `bits` those of the differences of the pixels of four lines from those to the right of them."""
    a, b, c, d = packet
    last = size - CHANNELS
    for i in range(last):
        k = i + CHANNELS
        upper = difference(a[i], a[k]) | difference(b[i], b[k])
        bits[i] = upper | difference(c[i], c[k]) | difference(d[i], d[k])
    for i in range(last, size):
        bits[i] = 0


def difference(a: Any, b: Any) -> Any:
    """The difference of two bytes, without its sign."""
    return max(a, b) - min(a, b)
