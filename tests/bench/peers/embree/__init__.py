"""Embree 4 from the package `embreex`, called as in C: packets of 16 coherent rays on all threads (`frames.cpp`).

The package's own Python interface traces single rays on one thread, which is no fair comparison. Its time is that of
the whole frame, without building its BVH. It has no planes and no capped cylinders: these are triangles.
"""

from __future__ import annotations

from ctypes import CDLL, POINTER, Structure, byref, c_char_p, c_float, c_int, c_size_t, c_uint, c_uint32, c_void_p, cast
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from minirt import load
from minirt.rendering.packing.camera import camera_numbers
from minirt.report.bench import runs
from minirt.shapes.sphere import Sphere
from tests.bench.measure import GLASS, INSTALL, MIRROR, MissingError, Setting, System
from tests.bench.triangles import light, triangulated
from tests.bench.yardstick import compiled

Array = NDArray[Any]
SOURCE = Path(__file__).with_name("frames.cpp")
COHERENT, ALL_FEATURES = 1 << 16, 0xFFFFFFFF
TRIANGLES, SPHERES = 0, 50  # RTCGeometryType
INDEX, VERTEX = 0, 1  # RTCBufferType
UINT3, FLOAT3, FLOAT4 = 0x5003, 0x9003, 0x9004  # RTCFormat
SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "rtcNewDevice": (c_size_t, [c_char_p]),
    "rtcNewScene": (c_size_t, [c_size_t]),
    "rtcNewGeometry": (c_size_t, [c_size_t, c_int]),
    "rtcSetSharedGeometryBuffer": (None, [c_size_t, c_int, c_uint, c_int, *[c_size_t] * 4]),
    "rtcCommitGeometry": (None, [c_size_t]),
    "rtcAttachGeometryByID": (None, [c_size_t, c_size_t, c_uint]),
    "rtcReleaseGeometry": (None, [c_size_t]),
    "rtcCommitScene": (None, [c_size_t]),
    "rtcGetDeviceError": (c_int, [c_size_t]),
}


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
    kept: list[Array]  # arrays that both read but do not own


def library() -> CDLL:
    """Load Embree's shared library, which the package `embreex` brings; `MissingError` without it."""
    found = find_spec("embreex")
    package = Path(found.origin).parent if found and found.origin else Path("/nowhere")
    beside = [each for folder in (package.parent / "embreex.libs", package) for each in folder.rglob("libembree4*")]
    if not beside:
        raise MissingError(f"Embree: embreex is not installed; {INSTALL}")
    loaded = CDLL(str(beside[0]))
    for name, (result, arguments) in SIGNATURES.items():
        function = getattr(loaded, name)
        function.restype, function.argtypes = result, arguments
    return loaded


class Embree(System):
    name = "Embree"
    how = "frames by packets of 16 rays, with cylinders and planes as triangles; the trees are built before"
    lacks = MIRROR, GLASS

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.embree = library()
        self.device = self.embree.rtcNewDevice(f"threads={setting.threads}".encode())
        program = compiled(setting.folder / "embree.so", [SOURCE], [], self.name, "-shared", "-fPIC")
        self.render_frame = CDLL(str(program)).render
        self.render_frame.argtypes = [POINTER(EmbreeC), POINTER(SceneC), c_void_p, c_int, c_int, c_int]
        self.render_frame.restype = None
        self.arguments = np.array([COHERENT, ALL_FEATURES, *[0] * 8], np.uint32)  # RTCIntersectArguments
        self.traceable = lru_cache(maxsize=2)(self.read)

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        embree, scene, _ = self.traceable(path)
        width, height, threads, _ = self.setting  # the size is in multiples of 4
        pixels = np.zeros((height, width), np.uint32)
        arguments = byref(embree), byref(scene), pixels.ctypes.data, width, height, threads
        self.render_frame(*arguments)
        times = [run.wall * 1e3 for run in runs(lambda: self.render_frame(*arguments), 1, seconds)]
        Image.fromarray(pixels.view(np.uint8).reshape(height, width, 4)).save(self.picture(path))
        return times

    def read(self, path: Path) -> Traceable:
        """Read a scene file and build Embree's BVH over its spheres, geometry 0, and the triangles of each shape."""
        scene, setting = load(path), self.setting
        handle = self.embree.rtcNewScene(self.device)
        others = [shape for shape in scene.shapes if not isinstance(shape, Sphere)]
        balls = np.array([[*each.centre, each.diameter / 2] for each in scene.spheres], np.float32).reshape(-1, 4)
        kept = [padded(balls)]
        if len(balls):
            self.attach(handle, 0, SPHERES, {VERTEX: (FLOAT4, kept[0], len(balls))})
        for number, (points, corners) in enumerate(map(triangulated, others), start=1):
            kept += [padded(points.astype(np.float32)), padded(corners.astype(np.uint32))]
            buffers = {VERTEX: (FLOAT3, kept[-2], len(points)), INDEX: (UINT3, kept[-1], len(corners))}
            self.attach(handle, number, TRIANGLES, buffers)
        self.embree.rtcCommitScene(handle)
        if error := self.embree.rtcGetDeviceError(self.device):
            raise RuntimeError(f"Embree says {error}")
        levels = np.array([shape.colour for shape in (*scene.spheres, *others)], np.uint32)
        colours = levels @ np.array([1, 1 << 8, 1 << 16], np.uint32)  # 0xBBGGRR
        lights = np.array([[*each.position, *light(each)] for each in scene.lights], np.float32).reshape(-1, 6)
        functions = [cast(getattr(self.embree, f"rtc{name}16"), c_void_p).value for name in ("Intersect", "Occluded")]
        view = tuple(camera_numbers(scene.camera, setting.width, setting.height).tolist())
        figures = len(lights), lights.ctypes.data, colours.ctypes.data, len(balls)
        embree = EmbreeC(*functions, handle, self.arguments.ctypes.data)
        return Traceable(embree, SceneC(view, light(scene.ambient), *figures), [*kept, colours, lights])

    def attach(self, scene: int, number: int, kind: int, buffers: dict[int, tuple[int, Array, int]]) -> None:
        """Add a geometry to a scene, given its buffers: their format, array and number of rows."""
        geometry = self.embree.rtcNewGeometry(self.device, kind)
        for buffer, (form, array, count) in buffers.items():
            place, stride = array.ctypes.data, array.strides[0]
            self.embree.rtcSetSharedGeometryBuffer(geometry, buffer, 0, form, place, 0, stride, count)
        self.embree.rtcCommitGeometry(geometry)
        self.embree.rtcAttachGeometryByID(scene, geometry, number)
        self.embree.rtcReleaseGeometry(geometry)  # the scene holds it


def padded(rows: Array) -> Array:
    """Copy rows and add an empty one, since Embree reads 16 bytes at a time."""
    return np.concatenate([rows, np.zeros_like(rows, shape=(1, *rows.shape[1:]))])
