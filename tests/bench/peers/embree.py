"""Embree 4 from the package `embreex`, called as in C: packets of 16 coherent rays, compiled, on all threads.

The package's own Python interface traces single rays on one thread, which is no fair comparison. Spheres are Embree's
own; it has no planes and no capped cylinders, so these are triangles: 2 * 64 for the side of a cylinder, 64 for each
cap, two for a plane. Its time is that of the whole frame, without building its BVH.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from ctypes import CDLL, c_char_p, c_int, c_size_t, c_uint
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from minirt import load
from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.bench.peers.command import light
from tests.bench.peers.triangles import cylinder, plane
from tests.bench.system import INSTALL, MissingError, Setting, System

Floats = NDArray[np.float32]
Words = NDArray[np.float32] | NDArray[np.uint32]

TRIANGLES, SPHERES = 0, 50  # RTCGeometryType
INDEX, VERTEX = 0, 1  # RTCBufferType
UINT3, FLOAT3, FLOAT4 = 0x5003, 0x9003, 0x9004  # RTCFormat
COHERENT, ALL_FEATURES = 1 << 16, 0xFFFFFFFF
ROWS = 16  # rows of pixels that a thread renders at a time
SIGNATURES = {
    "rtcNewDevice": (c_size_t, [c_char_p]),
    "rtcNewScene": (c_size_t, [c_size_t]),
    "rtcNewGeometry": (c_size_t, [c_size_t, c_int]),
    "rtcSetSharedGeometryBuffer": (None, [c_size_t, c_int, c_uint, c_int, *[c_size_t] * 4]),
    "rtcCommitGeometry": (None, [c_size_t]),
    "rtcAttachGeometry": (c_uint, [c_size_t, c_size_t]),
    "rtcCommitScene": (None, [c_size_t]),
    "rtcGetDeviceError": (c_int, [c_size_t]),
    "rtcIntersect16": (None, [c_size_t] * 4),
    "rtcOccluded16": (None, [c_size_t] * 4),
}


def library() -> CDLL:
    """Load Embree's shared library, which the package `embreex` brings; `MissingError` without it."""
    found = find_spec("embreex")
    if found is None or found.origin is None:
        raise MissingError(f"Embree: embreex is not installed; {INSTALL}")
    package = Path(found.origin).parent
    beside = [each for folder in (package.parent / "embreex.libs", package) for each in folder.rglob("libembree4*")]
    if not beside:
        raise MissingError("Embree: embreex holds no libembree4")
    loaded = CDLL(str(beside[0]))
    for name, (result, arguments) in SIGNATURES.items():
        function = getattr(loaded, name)
        function.restype, function.argtypes = result, arguments
    return loaded


class Traceable(NamedTuple):
    """A scene prepared for Embree and the kernel around it."""

    handle: int  # of Embree's scene
    camera: Floats
    ambient: Floats
    lights: Floats  # position and radiance of each light
    colours: Floats  # of spheres, then of triangles
    starts: NDArray[np.int64]  # first row in `colours` of each geometry
    kept: list[Words]  # buffers that Embree reads but does not own


class Embree(System):
    name = "Embree"
    how = "frames by packets of 16 rays, with cylinders and planes as triangles; the trees are built before"

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.library = library()
        self.device = self.library.rtcNewDevice(f"threads={setting.threads}".encode())
        self.pool = ThreadPoolExecutor(setting.threads)
        self.arguments = np.array([COHERENT, ALL_FEATURES, *[0] * 8], np.uint32)  # RTCIntersectArguments
        self.traceable = lru_cache(maxsize=1)(self.read)

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        scene = self.traceable(path)
        pixels = np.zeros((self.setting.height, self.setting.width, 3), np.uint8)
        self.render(scene, pixels)
        times: list[float] = []
        while not times or sum(times) < seconds * 1e3:
            start = perf_counter()
            self.render(scene, pixels)
            times.append((perf_counter() - start) * 1e3)
        Image.fromarray(pixels).save(self.picture(path))
        return times

    def render(self, scene: Traceable, pixels: NDArray[np.uint8]) -> None:
        """Render a frame in bands of rows, which the threads take one after the other."""
        from tests.bench.peers.embree_rays import render_rows

        calls = self.library.rtcIntersect16, self.library.rtcOccluded16
        handles = scene.handle, self.arguments.ctypes.data
        list(
            self.pool.map(
                lambda top: render_rows(
                    *calls, *handles, *scene[1:6], pixels, top, min(top + ROWS, self.setting.height)
                ),
                range(0, self.setting.height, ROWS),
            )
        )

    def read(self, path: Path) -> Traceable:
        """Read a scene file and build Embree's BVH over it."""
        scene = load(path)
        handle = self.library.rtcNewScene(self.device)
        balls = np.array([[*each.centre, each.diameter / 2] for each in scene.spheres], np.float32).reshape(-1, 4)
        corners, owners = triangles(scene)
        places = np.zeros((len(corners) * 3, 4), np.float32)
        places[:, :3] = corners.reshape(-1, 3)
        indices = np.arange(len(places) + 1, dtype=np.uint32)  # one more: Embree reads 16 bytes at a time
        self.attach(handle, SPHERES, {VERTEX: (FLOAT4, balls, 16, len(balls))})
        self.attach(
            handle, TRIANGLES, {VERTEX: (FLOAT3, places, 16, len(places)), INDEX: (UINT3, indices, 12, len(corners))}
        )
        self.library.rtcCommitScene(handle)
        if error := self.library.rtcGetDeviceError(self.device):
            raise RuntimeError(f"Embree says {error}")
        colours = np.array([each.colour for each in scene.spheres] + owners, np.float32).reshape(-1, 3) / np.float32(
            255
        )
        return Traceable(
            handle,
            camera_numbers(scene.camera, self.setting.width, self.setting.height).astype(np.float32),
            np.array(light(scene.ambient), np.float32),
            np.array([[*lamp.position, *light(lamp)] for lamp in scene.lights], np.float32).reshape(-1, 6),
            colours,
            np.array([0, len(balls)]),
            [balls, places, indices],
        )

    def attach(self, scene: int, kind: int, buffers: dict[int, tuple[int, Words, int, int]]) -> None:
        """Add a geometry to a scene, given its buffers: their format, array, stride in bytes and number of items."""
        geometry = self.library.rtcNewGeometry(self.device, kind)
        for buffer, (form, array, stride, count) in buffers.items():
            self.library.rtcSetSharedGeometryBuffer(geometry, buffer, 0, form, array.ctypes.data, 0, stride, count)
        self.library.rtcCommitGeometry(geometry)
        self.library.rtcAttachGeometry(scene, geometry)


def triangles(scene: Scene) -> tuple[Floats, list[tuple[float, float, float]]]:
    """Return the corners (n, 3, 3) of all planes and cylinders as triangles, and the colour of each triangle."""
    parts = [np.zeros((0, 3, 3))]
    colours = []
    for shape in scene.shapes:
        match shape:
            case Cylinder():
                parts.append(cylinder(shape))
            case Plane():
                parts.append(plane(shape))
            case Sphere():
                continue
            case _:
                raise ValueError(f"no triangles for {shape}")
        colours += [shape.colour] * len(parts[-1])
    return np.concatenate(parts).astype(np.float32), colours
