"""Mitsuba 3 from the package `mitsuba`, with its LLVM back end, whose rays Embree traces.

Its own integrators light surfaces by other formulas, so a frame is a kernel of a few lines around its rays. Dr.Jit
compiles it once for a scene, to vector code that runs on all threads. Its time is that of the whole frame, without
building trees and compiling.
"""

from __future__ import annotations

import sys
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

from minirt import load
from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Scene
from tests.bench.peers.command import light
from tests.bench.peers.mitsuba_scene import loaded
from tests.bench.system import INSTALL, MissingError, Setting, System
from tests.processes import run

VARIANT = "llvm_ad_rgb"
OFF_SURFACE = 1e-3  # offset of shadow rays
# Run by itself, because an LLVM that is too old for Dr.Jit ends the whole program.
PROBE = f"""
import drjit, mitsuba
mitsuba.set_variant({VARIANT!r})
numbers = mitsuba.Float([1, 2])
assert drjit.minimum(numbers, drjit.maximum(numbers, 3))[1] == 2
"""


class Traceable(NamedTuple):
    """A scene in Mitsuba, with what its frames need; arrays are Dr.Jit's."""

    scene: Any
    camera: Any  # the 12 numbers of `camera_numbers`
    colours: Any  # red, green, blue of each shape, by its number in Dr.Jit
    ambient: Any
    lights: list[tuple[Any, Any]]  # position and radiance


class Mitsuba(System):
    name = "Mitsuba 3"
    how = "frames by vector code that its LLVM back end compiles, traced by its Embree; the trees are built before"

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        if find_spec("mitsuba") is None:
            raise MissingError(f"{self.name}: mitsuba is not installed; {INSTALL}")
        probed = run([sys.executable, "-c", PROBE], text=True)
        if probed.returncode:
            complaint = (probed.stderr or probed.stdout).strip().splitlines() or [f"status {probed.returncode}"]
            raise MissingError(f"{self.name}: finds no LLVM that it can use (needs libllvm17 or newer): {complaint[0]}")
        self.mitsuba, self.drjit = import_module("mitsuba"), import_module("drjit")
        self.mitsuba.set_variant(VARIANT)
        self.mitsuba.set_log_level(self.mitsuba.LogLevel.Error)
        self.drjit.set_thread_count(setting.threads)
        self.traceable = lru_cache(maxsize=4)(self.read)

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        traceable = self.traceable(path)
        self.render(traceable)
        times: list[float] = []
        while not times or sum(times) < seconds * 1e3:
            start = perf_counter()
            pixels = self.render(traceable)
            times.append((perf_counter() - start) * 1e3)
        width, height, *_ = self.setting
        Image.fromarray(pixels.numpy().view(np.uint8).reshape(height, width, 4)).save(self.picture(path))
        return times

    def render(self, traceable: Traceable) -> Any:
        """Render a frame into RGBA pixels."""
        pixels = self.frame(*traceable)
        self.drjit.eval(pixels)
        self.drjit.sync_thread()
        return pixels

    def frame(self, scene: Any, camera: Any, colours: Any, ambient: Any, lights: list[tuple[Any, Any]]) -> Any:
        """Return the expression of a frame, which `drjit.eval` compiles and runs."""
        mi, dr = self.mitsuba, self.drjit
        width, height, *_ = self.setting
        number = dr.arange(mi.UInt32, width * height)
        eye, right, up, forward = (mi.Vector3f(*camera[k : k + 3]) for k in range(0, 12, 3))
        x = 2 * (mi.Float(number % width) + 0.5) / width - 1
        y = 1 - 2 * (mi.Float(number // width) + 0.5) / height
        ray = mi.Ray3f(mi.Point3f(eye), dr.normalize(forward + x * right + y * up))
        found = scene.ray_intersect(ray, ray_flags=mi.RayFlags.Minimal, coherent=True)
        hit = found.is_valid()
        normal = dr.mulsign(found.n, -dr.dot(found.n, ray.d))
        point = found.p + OFF_SURFACE * normal
        received = mi.Color3f(ambient)
        for position, radiance in lights:
            way = mi.Point3f(position) - point
            distance = dr.norm(way)
            cosine = dr.dot(normal, way) / distance
            faces = hit & (cosine > 0)
            shadow_ray = mi.Ray3f(point, way / distance, distance, 0.0, [])
            hidden = scene.ray_test(shadow_ray, coherent=True, active=faces)
            received += dr.select(faces & ~hidden, cosine, 0) * radiance
        colour = dr.gather(mi.Color3f, colours, dr.reinterpret_array(mi.UInt32, found.shape), hit)
        levels = mi.Vector3u(dr.minimum(received * colour, 1) * 255 + 0.5)
        return levels.x | levels.y << 8 | levels.z << 16 | 0xFF000000

    def read(self, path: Path) -> Traceable:
        """Read a scene file and build Mitsuba's scene of it."""
        scene = load(path)
        mi = self.mitsuba
        made, colours = loaded(mi, scene)
        numbers = self.drjit.reinterpret_array(mi.UInt32, made.shapes_dr()).numpy()
        table = np.zeros((numbers.max() + 1, 3), np.float32)
        for number, shape in zip(numbers, made.shapes(), strict=True):
            table[number] = colours[shape.id()]
        return Traceable(
            made,
            self.opaque(self.numbers(scene)),
            self.opaque(mi.Float(table.ravel() / 255)),
            self.opaque(mi.Color3f(light(scene.ambient))),
            [(self.opaque(mi.Point3f(each.position)), self.opaque(mi.Color3f(light(each)))) for each in scene.lights],
        )

    def numbers(self, scene: Scene) -> list[Any]:
        """Return the numbers of the camera."""
        numbers = camera_numbers(scene.camera, self.setting.width, self.setting.height)
        return [self.mitsuba.Float(each) for each in numbers.tolist()]

    def opaque(self, value: Any) -> Any:
        """Return a value that is no constant of the compiled code."""
        self.drjit.make_opaque(value)
        return value
