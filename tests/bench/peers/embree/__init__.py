"""Embree 4 from the package `embreex`, called as in C: packets of 16 coherent rays on all threads (`frames.cpp`).

The package's own Python interface traces single rays on one thread, which is no fair comparison. Its time is that of
the whole frame, without building its BVH. It has no planes and no capped cylinders: these are triangles.
"""

from __future__ import annotations

from ctypes import CDLL, POINTER, Structure, byref, c_float, c_int, c_uint32, c_void_p
from functools import lru_cache
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from minirt import load
from minirt.fields import Triple
from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.mesh import Mesh
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.sphere import Sphere
from tests.bench.measure import Setting, System
from tests.bench.peers.embree.library import Device, library
from tests.bench.triangles import Corners, Triangles, light, triangulated
from tests.bench.yardstick import compiled

SOURCE = Path(__file__).with_name("frames.cpp")
COHERENT, ALL_FEATURES = 1 << 16, 0xFFFFFFFF


class EmbreeC(Structure):
    """`Embree` of frames.cpp."""

    _fields_ = [(name, c_void_p) for name in ("intersect", "occluded", "scene", "arguments")]


class SceneC(Structure):
    """`Scene` of frames.cpp."""

    _fields_ = [
        ("view", c_float * 12),
        ("ambient", c_float * 3),
        ("light_count", c_int),
        ("lights", c_void_p),
        ("colours", c_void_p),
        ("sphere_count", c_uint32),
    ]


class Traceable(NamedTuple):
    """A scene prepared for Embree and the frames around it."""

    embree: EmbreeC
    scene: SceneC
    kept: list[NDArray[Any]]  # arrays that both read but do not own


class Embree(System):
    name = "Embree"
    how = "frames by packets of 16 rays, with cylinders and planes as triangles; the trees are built before"

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.device = Device(library(), setting.threads)
        program = compiled(setting.folder / "embree.so", [SOURCE], [], self.name, "-shared", "-fPIC")
        self.render_frame = CDLL(str(program)).render
        self.render_frame.argtypes = [POINTER(EmbreeC), POINTER(SceneC), c_void_p, c_int, c_int, c_int]
        self.render_frame.restype = None
        self.arguments = np.array([COHERENT, ALL_FEATURES, *[0] * 8], np.uint32)  # RTCIntersectArguments
        self.traceable = lru_cache(maxsize=2)(self.read)

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        traceable = self.traceable(path)
        pixels = np.zeros((self.setting.height, self.setting.width), np.uint32)
        self.render(traceable, pixels)
        times: list[float] = []
        while not times or sum(times) < seconds * 1e3:
            start = perf_counter()
            self.render(traceable, pixels)
            times.append((perf_counter() - start) * 1e3)
        Image.fromarray(pixels.view(np.uint8).reshape(*pixels.shape, 4)).save(self.picture(path))
        return times

    def render(self, traceable: Traceable, pixels: NDArray[np.uint32]) -> None:
        """Render a frame; its height and width are multiples of 4."""
        embree, scene, _ = traceable
        height, width = pixels.shape
        self.render_frame(byref(embree), byref(scene), pixels.ctypes.data, width, height, self.setting.threads)

    def read(self, path: Path) -> Traceable:
        """Read a scene file and build Embree's BVH over it."""
        scene = load(path)
        built = self.device.scene(spheres(scene), [triangulated(each) for each in others(scene)])
        colours, lights = packed_colours(scene), packed_lights(scene)
        setting = self.setting
        return Traceable(
            EmbreeC(
                self.device.address("rtcIntersect16"),
                self.device.address("rtcOccluded16"),
                built.handle,
                self.arguments.ctypes.data,
            ),
            SceneC(
                tuple(camera_numbers(scene.camera, setting.width, setting.height).tolist()),
                light(scene.ambient),
                len(lights),
                lights.ctypes.data,
                colours.ctypes.data,
                len(scene.spheres),
            ),
            [*built.kept, colours, lights],
        )


def spheres(scene: Scene) -> NDArray[np.float32]:
    """Return the centre and the radius of each sphere."""
    return np.array([[*each.centre, each.diameter / 2] for each in scene.spheres], np.float32).reshape(-1, 4)


def others(scene: Scene) -> list[Shape]:
    """Return the shapes that are triangles to Embree."""
    return [shape for shape in scene.shapes if not isinstance(shape, Sphere)]


def packed_colours(scene: Scene) -> NDArray[np.uint32]:
    """Return the colours of the spheres, then of the other shapes, as 0xBBGGRR."""
    levels = np.array([shape.colour for shape in (*scene.spheres, *others(scene))], np.uint32)
    return levels @ np.array([1, 1 << 8, 1 << 16], np.uint32)


def packed_lights(scene: Scene) -> NDArray[np.float32]:
    """Return the position and the radiance of each light."""
    return np.array([[*each.position, *light(each)] for each in scene.lights], np.float32).reshape(-1, 6)
