"""Settings of a picture, rendering it, and its identity: for the library, the command line, workers and journals."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from inspect import Parameter, signature
from math import inf
from numbers import Real
from typing import Any, Literal, TypedDict, TypeVar, Unpack, overload

import numpy as np

from minirt.element import Element, fields_of
from minirt.errors import RenderError, check_whole
from minirt.fields import MeshFile
from minirt.helpers import file_io, system
from minirt.helpers.progress import WorkState, in_notebooks
from minirt.kernel.machine_code.fingerprint import V3, fingerprint_of
from minirt.records import Immutable, record
from minirt.rendering.image import Image, LinearImage, rgb_of
from minirt.rendering.packing.camera import cut_for
from minirt.rendering.renderer import Renderer, renderer
from minirt.scene import Scene, dump
from minirt.scene.arguments import check_scene
from minirt.scene.sizes import size_for

Function = TypeVar("Function", bound=Callable[..., Any])

DEFAULT_ERROR = 0.002  # half a level of 255: the least that a picture of bytes can show
CANCELLED = "the picture was cancelled"  # by `minirt.renderer(...).cancel()`, from another thread
PIXEL, LIGHT = 7, 24  # bytes of a pixel and its levels, and of its light, while they are rendered


class Keywords(TypedDict, total=False):
    """Types of the keywords that all functions take which render: the fields of `RenderSettings` but `linear`."""

    samples: int | Literal["auto"]
    error: float | None
    time: float | None
    threads: int | None
    precision: Literal["double", "single"]
    depth: int | None
    dither: bool
    region: tuple[int, int, int, int] | None


@record()
class RenderSettings(Immutable):
    """The keywords of `render`, which explains them; RenderError where they do not go together."""

    samples: int | Literal["auto"] = 1  # rays a pixel
    error: float | None = None  # RMSE at which samples="auto" end
    time: float | None = None  # seconds after which they end
    threads: int | None = None  # None: one for each processor
    precision: Literal["double", "single"] = "double"
    depth: int | None = None  # of reflections and refractions; None: 8
    linear: bool = True  # whether the picture has its light, too
    dither: bool = False  # whether blue noise replaces rounding to 8 bits
    region: tuple[int, int, int, int] | None = None  # x, y, width, height; None: the whole picture

    def __post_init__(self) -> None:
        for name, value in (("error", self.error), ("time", self.time)):
            if value is not None and self.samples != "auto":
                raise RenderError(f"an error or a time needs samples='auto', got {self.samples}")
            if value is not None and not (isinstance(value, Real) and value > 0):
                raise RenderError(f"{name} must be a number > 0, got {value!r}")
        if self.samples != "auto":
            check_whole("samples", self.samples, 1)

    def replace(self, **changes: Any) -> RenderSettings:
        return replace(self, **changes)

    @property
    def renderer(self) -> Renderer:
        """The renderer that all pictures with these threads, precision, depth and dithering share."""
        return renderer(self.threads, self.precision, self.depth, self.dither)


def takes_settings(function: Function, source: Callable[..., Any] | None = None) -> Function:
    """Decorate a function whose last parameter, `**settings`, are keywords of `source`: its signature names them.

    By default they are the keywords of `render`, of which `linear` is no setting."""
    own = signature(function)
    *first, _ = own.parameters.values()
    names = {"linear", *(each.name for each in first)}
    others = [each for each in signature(source or RenderSettings).parameters.values() if each.name not in names]
    further = [each.replace(kind=Parameter.KEYWORD_ONLY) for each in others]
    setattr(function, "__signature__", own.replace(parameters=[*first, *further]))  # noqa: B010  # help() reads it
    return function


@overload
def render(
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    linear: Literal[True] | None = None,
    rows: tuple[int, int] | None = None,
    **settings: Unpack[Keywords],
) -> LinearImage: ...


@overload
def render(
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    linear: bool,
    rows: tuple[int, int] | None = None,
    **settings: Unpack[Keywords],
) -> Image: ...


@takes_settings
def render(
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    linear: bool | None = None,
    rows: tuple[int, int] | None = None,
    **settings: Unpack[Keywords],
) -> Image:
    """Render a scene: `width` by `height` pixels, each the mean of `samples` rays.

    Without a size the scene's own is used. Safe to call from several threads. Where no kernel was compiled ahead of
    time, the first call for a combination of kinds of shapes compiles for some seconds. `precision` "single" computes
    in float32 relative to the eye, about twice as fast. Light is mirrored or refracted at most `depth` times, by
    default 8. RenderError for a size or a number of samples below 1.

    With `samples` "auto" each part of the picture gets as many samples as it needs, until the estimated error is at
    most `error` (DEFAULT_ERROR if neither is given) or `time` seconds have passed, compilation not counted; `.reached`
    of the picture tells which. Errors are defined in `minirt.rendering.outcome`. With `linear` False the picture has
    8 bits alone, and sampling also ends where rounding to them decides its error. By default a picture of one sample
    makes its `.linear` light when that is asked for, by rendering again; with `linear` True it keeps the light, which
    takes up to three times as long where frames are fast.

    Tone and exposure are those of the camera; light is exposed, but has no tone. `dither` replaces rounding to 8 bits
    by blue noise, so that smooth shades have no steps.

    `region` (x, y, width, height) renders that rectangle of the picture alone, at the cost of the rectangle: its pixels
    are those of the whole picture. With `samples` "auto" the error is that of the rectangle, and so are the samples.
    RenderError for a region that does not lie in the picture. `rows` (a, b) are the rows from a to b - 1.

    RenderError for a picture, textures or lists of shapes that need more memory than `minirt.limit_memory` allows.
    """
    check_scene(scene, "render")
    size = size_for(scene, width, height)
    if rows is not None:
        if settings.get("region") is not None:
            raise RenderError("a picture has a region or rows, not both")
        settings["region"] = (0, rows[0], size[0], rows[1] - rows[0])
    is_lit = settings.get("samples", 1) != 1 if linear is None else linear  # else one sample is drawn without light
    picture = rendered(scene, size, RenderSettings(linear=is_lit, **settings))
    if is_lit or linear is not None:
        return picture
    return LinearImage.lit_on_demand(picture, partial(render, scene, *size, linear=True, **settings))


def rendered(scene: Scene, size: tuple[int, int], settings: RenderSettings) -> Image:
    """Return the picture of a scene of this size, or the region of it that the settings name, as `minirt.render` does.
    RenderError where that fails or is cancelled."""
    crop, shape, kept, _ = cut_for(settings.region, *size)
    system.check_picture(*shape, PIXEL + (LIGHT if settings.linear or settings.dither else 0))
    pixels = np.empty((*shape, 4), np.uint8)
    light = np.zeros((*shape, 3)) if settings.linear else None
    chosen, reached = settings.renderer, None
    if settings.samples == "auto":
        error = settings.error or (DEFAULT_ERROR if settings.time is None else 0.0)
        seconds = inf if settings.time is None else settings.time
        if settings.time is not None:  # compiling does not count
            chosen.prepare(scene, settings.samples)
        with in_notebooks(lambda: WorkState("sampling")):
            reached = chosen.reach(scene, pixels, error, seconds, light, crop)
        is_done = reached is not None
    else:
        with in_notebooks(lambda: WorkState("picture", chosen.rows_done(len(pixels)))):
            is_done = chosen.render(scene, pixels, settings.samples, light, crop=crop)
    if not is_done:
        raise RenderError(CANCELLED)
    levels = rgb_of(pixels[kept], chosen.runner.run_on_all)
    about = reached, scene.camera.tone, chosen.not_finite
    if light is None:
        return Image(levels, None, *about)
    return LinearImage(levels, np.ascontiguousarray(light[kept]), *about)


def identity(scene: Scene, settings: str) -> str:
    """Return a hash of a scene, the contents of the files that it names, the settings and the sources of the kernel.
    FileError where a file cannot be read."""
    found = hashlib.sha256(f"{fingerprint_of(V3)} {settings} {scene.shown}\n{dump(scene)}".encode())
    found.update(repr([mesh.triangles.materials for mesh in scene.meshes]).encode())
    from minirt.meshes.from_arrays import digest

    for mesh in (mesh for mesh in scene.meshes if mesh.file.is_new):
        found.update(digest(mesh.triangles).encode())
    for name in sorted({name for element in scene.elements for name in files_of(element)}):
        data = file_io.read(scene.beside(name), file_io.LARGEST_ASSET)
        found.update(f"{name} {len(data)}\n".encode())
        found.update(data)
    return found.hexdigest()


def files_of(element: Element) -> Iterator[str]:
    """Yield the names of the pictures and meshes of an element, as the scene file has them, but not of new meshes."""
    for field in fields_of(type(element)):
        value = getattr(element, field.name)
        if isinstance(value, MeshFile) and not value.is_new:
            yield value.name
        if value is not None:
            yield from (each.name for each in field.pictures(value))
