"""Packets of 4 x 4 rays for Embree, and the shading of their hits."""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np

LANES, ACROSS = 16, 4
# Rows of an RTCRayHit16 with 16 numbers each; a vector takes three rows.
ORIGIN, NEAR, DIRECTION, TIME, FAR, MASK, FLAGS = 0, 3, 4, 7, 8, 9, 11
NORMAL, PRIMITIVE, GEOMETRY, INSTANCE = 12, 17, 18, 19
FIELDS = 24  # more than there are in any version
NONE = 0xFFFFFFFF
OFF_SURFACE = 1e-3  # offset of shadow rays, and least distance of a hit

compiled = numba.njit(nogil=True, error_model="numpy")


class Packet(NamedTuple):
    """Ray buffers of one thread."""

    rays: Any  # an RTCRayHit16
    words: Any  # the RTCRayHit16 viewed as integers
    shadows: Any  # an RTCRay16
    valid: Any  # -1 for an active ray
    points: Any
    normals: Any
    cosines: Any
    light: Any


@compiled  # type: ignore[untyped-decorator]
def aligned(rows: int) -> Any:
    """Allocate rows of 16 numbers at an address that is a multiple of 64."""
    words = np.zeros(rows * LANES + 16, np.float32)
    start = (64 - words.ctypes.data % 64) // 4
    return words[start : start + rows * LANES].reshape(rows, LANES)


@compiled  # type: ignore[untyped-decorator]
def dot(a: Any, b: Any) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]  # type: ignore[no-any-return]


@compiled  # type: ignore[untyped-decorator]
def aim(packet: Packet, camera: Any, x: int, y: int, width: int, height: int) -> None:
    """Point the rays at the pixels of a packet."""
    for i in range(LANES):
        right = 2 * (x + i % ACROSS + 0.5) / width - 1
        up = 1 - 2 * (y + i // ACROSS + 0.5) / height
        for k in range(3):
            packet.rays[ORIGIN + k, i] = camera[k]
            packet.rays[DIRECTION + k, i] = camera[9 + k] + right * camera[3 + k] + up * camera[6 + k]
    packet.rays[NEAR] = OFF_SURFACE
    packet.rays[FAR] = np.inf
    packet.words[MASK] = packet.words[GEOMETRY] = packet.words[INSTANCE] = NONE
    packet.valid[:] = -1


@compiled  # type: ignore[untyped-decorator]
def find_surfaces(packet: Packet) -> None:
    """Compute hit points, and normals on the visible side."""
    for i in range(LANES):
        if packet.words[GEOMETRY, i] == NONE:
            continue
        direction, normal = packet.rays[DIRECTION : DIRECTION + 3, i], packet.rays[NORMAL : NORMAL + 3, i]
        scale = np.copysign(1 / np.sqrt(dot(normal, normal)), -dot(normal, direction))
        for k in range(3):
            packet.normals[i, k] = scale * normal[k]
            hit = packet.rays[ORIGIN + k, i] + packet.rays[FAR, i] * direction[k]
            packet.points[i, k] = hit + OFF_SURFACE * packet.normals[i, k]


@compiled  # type: ignore[untyped-decorator]
def aim_at_lamp(packet: Packet, lamp: Any) -> bool:
    """Aim shadow rays from the surfaces at a light; return whether any surface faces it."""
    some = False
    for i in range(LANES):
        packet.valid[i] = 0
        if packet.words[GEOMETRY, i] != NONE:
            way = packet.shadows[DIRECTION : DIRECTION + 3, i]
            for k in range(3):
                packet.shadows[ORIGIN + k, i] = packet.points[i, k]
                way[k] = lamp[k] - packet.points[i, k]
            packet.cosines[i] = dot(packet.normals[i], way) / np.sqrt(dot(way, way))
            if packet.cosines[i] > 0:
                packet.valid[i] = -1
                some = True
    packet.shadows[FAR] = 1
    return some


@compiled  # type: ignore[untyped-decorator]
def store(packet: Packet, colours: Any, starts: Any, pixels: Any, x: int, y: int) -> None:
    """Write the shaded packet into the picture."""
    for i in range(LANES):
        pixel = pixels[y + i // ACROSS, x + i % ACROSS]
        if packet.words[GEOMETRY, i] == NONE:
            pixel[:] = 0
            continue
        colour = colours[starts[packet.words[GEOMETRY, i]] + packet.words[PRIMITIVE, i]]
        for k in range(3):
            pixel[k] = np.uint8(min(colour[k] * packet.light[i, k], 1) * 255 + 0.5)


@compiled  # type: ignore[untyped-decorator]
def render_rows(
    intersect: Any, occluded: Any, scene: int, arguments: int,
    camera: Any, ambient: Any, lights: Any, colours: Any, starts: Any,
    pixels: Any, top: int, end: int,
) -> None:  # fmt: skip
    """Render the rows from `top` to `end`; their number and the width are multiples of 4."""
    height, width, _ = pixels.shape
    rays, shadows, valid = aligned(FIELDS), aligned(FIELDS), aligned(1)[0].view(np.int32)
    vectors = np.zeros((3, LANES, 3), np.float32)
    cosines = np.zeros(LANES, np.float32)
    packet = Packet(rays, rays.view(np.uint32), shadows, valid, vectors[0], vectors[1], cosines, vectors[2])
    shadows.view(np.uint32)[MASK] = NONE
    for y in range(top, end, LANES // ACROSS):
        for x in range(0, width, ACROSS):
            aim(packet, camera, x, y, width, height)
            intersect(valid.ctypes.data, scene, rays.ctypes.data, arguments)
            find_surfaces(packet)
            packet.light[:] = ambient
            for lamp in lights:
                if aim_at_lamp(packet, lamp):
                    occluded(valid.ctypes.data, scene, shadows.ctypes.data, arguments)
                    for i in range(LANES):
                        if valid[i] and shadows[FAR, i] >= 0:
                            for k in range(3):
                                packet.light[i, k] += cosines[i] * lamp[3 + k]
            store(packet, colours, starts, pixels, x, y)
