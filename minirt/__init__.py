"""miniRT: ray-traced pictures of `.rt` scenes, in a window, in a file or in memory.

import minirt
scene = minirt.load("scenes/demo.rt")
minirt.render(scene, 640, 480, samples=4).save("demo.png")
"""

from __future__ import annotations

import os
import sys
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal, overload

from minirt.errors import RenderError as RenderError

if TYPE_CHECKING:  # the same names for type checkers, which see no `__getattr__`
    from minirt.cluster.pictures import render_all as render_all
    from minirt.cluster.pictures import render_to as render_to
    from minirt.element import Element as Element
    from minirt.errors import FileError as FileError
    from minirt.errors import MiniRTError as MiniRTError
    from minirt.errors import MlxError as MlxError
    from minirt.errors import ReplayError as ReplayError
    from minirt.errors import SceneError as SceneError
    from minirt.example_scenes import example as example
    from minirt.example_scenes import examples as examples
    from minirt.fields import MeshFile as MeshFile
    from minirt.helpers.system import limit_memory as limit_memory
    from minirt.materials import *  # noqa: F403
    from minirt.movie import save_movie as save_movie
    from minirt.notebook import view as view
    from minirt.rendering import Renderer as Renderer
    from minirt.rendering.buffers import Buffers as Buffers
    from minirt.rendering.buffers import buffers as buffers
    from minirt.rendering.image import Image as Image
    from minirt.rendering.image import LinearImage as LinearImage
    from minirt.rendering.queries.rays import Hits as Hits
    from minirt.rendering.queries.rays import camera_rays as camera_rays
    from minirt.rendering.queries.rays import trace as trace
    from minirt.rendering.renderer import renderer as renderer
    from minirt.rendering.settings import DEFAULT_ERROR as DEFAULT_ERROR
    from minirt.scene import DEFAULT_SIZE as DEFAULT_SIZE
    from minirt.scene import Ambient as Ambient
    from minirt.scene import Background as Background
    from minirt.scene import Camera as Camera
    from minirt.scene import FurtherLight as FurtherLight
    from minirt.scene import Lamp as Lamp
    from minirt.scene import Light as Light
    from minirt.scene import ParallelLight as ParallelLight
    from minirt.scene import Resolution as Resolution
    from minirt.scene import Scene as Scene
    from minirt.scene import SpotLight as SpotLight
    from minirt.scene import dumps as dumps
    from minirt.scene import loads as loads
    from minirt.scene import size_of as size_of
    from minirt.shapes import *  # noqa: F403

__version__ = "0.1.0"

# Names that are imported on first use, so that `miniRT --help` need not wait for them.
MODULES = {
    "minirt.cluster.pictures": ("render_all", "render_to"),
    "minirt.element": ("Element",),
    "minirt.errors": ("FileError", "MiniRTError", "MlxError", "ReplayError", "SceneError"),
    "minirt.example_scenes": ("example", "examples"),
    "minirt.fields": ("MeshFile",),
    "minirt.rendering.image": ("Image", "LinearImage"),
    "minirt.helpers.system": ("limit_memory",),
    "minirt.notebook": ("view",),
    "minirt.rendering": ("Renderer",),
    "minirt.rendering.buffers": ("Buffers", "buffers"),
    "minirt.rendering.renderer": ("renderer",),
    "minirt.rendering.settings": ("DEFAULT_ERROR",),
    "minirt.rendering.queries.rays": ("Hits", "camera_rays", "trace"),
    "minirt.movie": ("save_movie",),
    "minirt.scene": (
        *("Ambient", "Background", "Camera", "Lamp", "Resolution", "Scene", "dumps", "loads"),
        *("DEFAULT_SIZE", "size_of"),
    ),
    "minirt.shapes": ("Shape",),
}
HOMES = {name: module for module, names in MODULES.items() for name in names}
REGISTRIES = (
    "minirt.shapes",
    "minirt.materials",
    "minirt.scene.lights",
)  # the names in their `PUBLIC` are public here, too
OWN = ("RenderError", "load", "render")

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        if name in HOMES:
            return getattr(import_module(HOMES[name]), name)
        if name == "__all__":  # asked for by `from minirt import *`, and by pdoc, which then reads the names' values
            globals().update({each: getattr(sys.modules[__name__], each) for each in public_names()})
            return public_names()
        if name[:1].isupper() and name in registered():  # modules, which imports look up here, are lower case
            return registered()[name]
        raise AttributeError(f"module 'minirt' has no attribute '{name}'")


def __dir__() -> list[str]:
    return [*(name for name in globals() if name.startswith("__")), *public_names()]


def public_names() -> list[str]:
    """All public names, in alphabetical order."""
    return sorted((*OWN, *HOMES, *registered()))


@cache
def registered() -> dict[str, type]:
    """The shapes, materials and lights by their public names: `minirt.Sphere`, `minirt.Glass`, `minirt.Light`."""
    return {name: kind for home in REGISTRIES for name, kind in import_module(home).PUBLIC.items()}


def load(path: str | os.PathLike[str], lenient: bool = False, left_handed: bool = False) -> Scene:
    """Read a scene file. SceneError, with all of its problems, if the file is not a valid scene.

    `lenient` accepts older spellings: several `L`, blanks around commas, colours with decimals and the like.
    `left_handed` mirrors pictures of the scene, as renderers with left-handed coordinates do.
    """
    from minirt.scene import load as read

    return read(path, lenient, left_handed).scene


@overload
def render(
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    samples: int | Literal["auto"] = 1,
    error: float | None = None,
    time: float | None = None,
    threads: int | None = None,
    precision: Literal["double", "single"] = "double",
    depth: int | None = None,
    linear: Literal[True] = True,
    dither: bool = False,
    region: tuple[int, int, int, int] | None = None,
    rows: tuple[int, int] | None = None,
) -> LinearImage: ...


@overload
def render(
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    samples: int | Literal["auto"] = 1,
    error: float | None = None,
    time: float | None = None,
    threads: int | None = None,
    precision: Literal["double", "single"] = "double",
    depth: int | None = None,
    linear: bool,
    dither: bool = False,
    region: tuple[int, int, int, int] | None = None,
    rows: tuple[int, int] | None = None,
) -> Image: ...


def render(
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    samples: int | Literal["auto"] = 1,
    error: float | None = None,
    time: float | None = None,
    threads: int | None = None,
    precision: Literal["double", "single"] = "double",
    depth: int | None = None,
    linear: bool = True,
    dither: bool = False,
    region: tuple[int, int, int, int] | None = None,
    rows: tuple[int, int] | None = None,
) -> Image:
    """Render a scene: `width` by `height` pixels, each the mean of `samples` rays.

    Without a size the scene's own is used. Safe to call from several threads. Where no kernel was compiled ahead of
    time, the first call for a combination of kinds of shapes compiles for some seconds. `precision` "single" computes
    in float32 relative to the eye, about twice as fast. Light is mirrored or refracted at most `depth` times, by
    default 8. RenderError for a size or a number of samples below 1.

    With `samples` "auto" each part of the picture gets as many samples as it needs, until the estimated error is at
    most `error` (DEFAULT_ERROR if neither is given) or `time` seconds have passed, compilation not counted; `.reached`
    of the picture tells which. Errors are defined in `minirt.rendering.outcome`. Without `linear` light, the
    picture has 8 bits alone, and sampling also ends where rounding to them decides its error.

    Tone and exposure are those of the camera; light is exposed, but has no tone. `dither` replaces rounding to 8 bits
    by blue noise, so that smooth shades have no steps.

    `region` (x, y, width, height) renders that rectangle of the picture alone, at the cost of the rectangle: its pixels
    are those of the whole picture. With `samples` "auto" the error is that of the rectangle, and so are the samples.
    RenderError for a region that does not lie in the picture. `rows` (a, b) are the rows from a to b - 1.

    RenderError for a picture, textures or lists of shapes that need more memory than `minirt.limit_memory` allows.
    """
    from minirt.rendering.packing.camera import Region
    from minirt.rendering.settings import RenderSettings, rendered
    from minirt.scene.scene import check_scene, size_for

    check_scene(scene, "render")
    size = size_for(scene, width, height)
    if rows is not None:
        if region is not None:
            raise RenderError("a picture has a region or rows, not both")
        region = (0, rows[0], size[0], rows[1] - rows[0])
    part = region and Region(*region)
    return rendered(scene, size, RenderSettings(samples, error, time, threads, precision, depth, linear, dither, part))
