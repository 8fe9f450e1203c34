"""Embree's shared library: its device, and scenes of spheres and triangles."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import CDLL, c_char_p, c_int, c_size_t, c_uint, c_void_p, cast
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.bench.measure import INSTALL, MissingError
from tests.bench.triangles import Triangles

TRIANGLES, SPHERES = 0, 50  # RTCGeometryType
INDEX, VERTEX = 0, 1  # RTCBufferType
UINT3, FLOAT3, FLOAT4 = 0x5003, 0x9003, 0x9004  # RTCFormat
SIGNATURES = {
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


class Built(NamedTuple):
    """A scene of Embree, and the arrays that it reads but does not own."""

    handle: int
    kept: list[NDArray[Any]]


class Device:
    """A device of Embree, which builds its trees on a number of threads."""

    def __init__(self, embree: CDLL, threads: int) -> None:
        self.embree = embree
        self.handle = embree.rtcNewDevice(f"threads={threads}".encode())

    def address(self, function: str) -> int:
        """Return the address of a function of Embree."""
        return cast(getattr(self.embree, function), c_void_p).value or 0

    def scene(self, spheres: NDArray[np.float32], others: Sequence[Triangles]) -> Built:
        """Build the tree over spheres (n, 4), which are geometry 0, and over the triangles of each further one."""
        handle = self.embree.rtcNewScene(self.handle)
        kept: list[NDArray[Any]] = []
        if len(spheres):
            kept.append(padded(spheres))
            self.attach(handle, 0, SPHERES, {VERTEX: (FLOAT4, kept[-1], len(spheres))})
        for number, (points, corners) in enumerate(others, start=1):
            kept += [padded(points.astype(np.float32)), padded(corners.astype(np.uint32))]
            buffers = {VERTEX: (FLOAT3, kept[-2], len(points)), INDEX: (UINT3, kept[-1], len(corners))}
            self.attach(handle, number, TRIANGLES, buffers)
        self.embree.rtcCommitScene(handle)
        if error := self.embree.rtcGetDeviceError(self.handle):
            raise RuntimeError(f"Embree says {error}")
        return Built(handle, kept)

    def attach(self, scene: int, number: int, kind: int, buffers: dict[int, tuple[int, NDArray[Any], int]]) -> None:
        """Add a geometry to a scene, given its buffers: their format, array and number of rows."""
        geometry = self.embree.rtcNewGeometry(self.handle, kind)
        for buffer, (form, array, count) in buffers.items():
            place, stride = array.ctypes.data, array.strides[0]
            self.embree.rtcSetSharedGeometryBuffer(geometry, buffer, 0, form, place, 0, stride, count)
        self.embree.rtcCommitGeometry(geometry)
        self.embree.rtcAttachGeometryByID(scene, geometry, number)
        self.embree.rtcReleaseGeometry(geometry)  # the scene holds it


def padded(rows: NDArray[Any]) -> NDArray[Any]:
    """Copy rows and add an empty one, since Embree reads 16 bytes at a time."""
    return np.concatenate([rows, np.zeros_like(rows, shape=(1, *rows.shape[1:]))])
