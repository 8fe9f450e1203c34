"""miniRT: ray-traced pictures of `.rt` scenes, in a window, in a file or in memory.

import minirt
scene = minirt.load("scenes/demo.rt")
minirt.render(scene, 640, 480, samples=4).save("demo.png")
"""

from __future__ import annotations

import os
from functools import cache
from importlib import import_module
from math import inf
from typing import TYPE_CHECKING, Any, Literal

from minirt.errors import RenderError as RenderError

if TYPE_CHECKING:  # the same names for type checkers, which see no `__getattr__`
    from minirt.errors import MiniRTError as MiniRTError
    from minirt.errors import MlxError as MlxError
    from minirt.errors import ReplayError as ReplayError
    from minirt.errors import SceneError as SceneError
    from minirt.image import Image as Image
    from minirt.materials import *  # noqa: F403
    from minirt.movie import save_movie as save_movie
    from minirt.rendering import Renderer
    from minirt.rendering.queries.hits import Hits as Hits
    from minirt.rendering.queries.rays import trace as trace
    from minirt.scene import Ambient as Ambient
    from minirt.scene import Background as Background
    from minirt.scene import Camera as Camera
    from minirt.scene import FurtherLight as FurtherLight
    from minirt.scene import Light as Light
    from minirt.scene import ParallelLight as ParallelLight
    from minirt.scene import Scene as Scene
    from minirt.scene import SpotLight as SpotLight
    from minirt.shapes import *  # noqa: F403
    from minirt.viewer import view as view

__version__ = "0.1.0"
DEFAULT_ERROR = 0.002  # half a level of 255: the least that a picture of bytes can show
DEFAULT_SIZE = (1280, 720)  # pixels, for a scene that does not name a size

# Names that are imported on first use, so that `miniRT --help` need not wait for them.
HOMES = {
    **dict.fromkeys(("MiniRTError", "MlxError", "RenderError", "ReplayError", "SceneError"), "minirt.errors"),
    "Image": "minirt.image",
    **dict.fromkeys(
        ("Ambient", "Background", "Camera", "FurtherLight", "Light", "ParallelLight", "Scene", "SpotLight"),
        "minirt.scene",
    ),
    "Hits": "minirt.rendering.queries.hits",
    "trace": "minirt.rendering.queries.rays",
    "save_movie": "minirt.movie",
    "view": "minirt.viewer",
}
REGISTRIES = ("minirt.shapes", "minirt.materials")  # the names in their `PUBLIC` are public here, too


def __getattr__(name: str) -> Any:
    if name in HOMES:
        return getattr(import_module(HOMES[name]), name)
    if name == "__all__":
        return sorted((*HOMES, *registered(), "load", "render", "size_of"))
    if name[:1].isupper() and name in registered():  # modules, which imports look up here, are lower case
        return registered()[name]
    raise AttributeError(f"module 'minirt' has no attribute '{name}'")


def __dir__() -> list[str]:
    return [*globals(), *__getattr__("__all__")]


@cache
def registered() -> dict[str, type]:
    """The shapes and materials by their public names: `minirt.Sphere`, `minirt.Glass`."""
    return {name: kind for home in REGISTRIES for name, kind in import_module(home).PUBLIC.items()}


def load(path: str | os.PathLike[str], lenient: bool = False, left_handed: bool = False) -> Scene:
    """Read a scene file. SceneError, with all of its problems, if the file is not a valid scene.

    `lenient` accepts older spellings: several `L`, blanks around commas, colours with decimals and the like.
    `left_handed` mirrors pictures of the scene, as renderers with left-handed coordinates do.
    """
    from minirt.scene import load as read

    return read(path, lenient, left_handed).scene


def size_of(scene: Scene) -> tuple[int, int]:
    """Width and height in pixels that a scene asks for, or the default."""
    return (scene.resolution.width, scene.resolution.height) if scene.resolution else DEFAULT_SIZE


def render(
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    samples: int | Literal["auto"] = 1,
    error: float | None = None,
    time: float | None = None,
    threads: int | None = None,
    precision: str = "double",
    depth: int | None = None,
    linear: bool = True,
    dither: bool = False,
) -> Image:
    """Render a scene: `width` by `height` pixels, each the mean of `samples` rays.

    Without a size the scene's own is used. Safe to call from several threads. Where no kernel was compiled ahead of
    time, the first call for a combination of kinds of shapes compiles for some seconds. `precision` "single" computes
    in float32 relative to the eye, about twice as fast. Light is mirrored or refracted at most `depth` times, by
    default 8. RenderError for a size or a number of samples below 1.

    With `samples` "auto" each part of the picture gets as many samples as it needs, until the estimated error is at
    most `error` (DEFAULT_ERROR if neither is given) or `time` seconds have passed, compilation not counted; `.reached`
    of the picture tells which. Errors are defined in `minirt.rendering.sampling.outcome`. Without `linear` light, the
    picture has 8 bits alone, and sampling also ends where rounding to them decides its error.

    Tone and exposure are those of the camera; light is exposed, but has no tone. `dither` replaces rounding to 8 bits
    by blue noise, so that smooth shades have no steps.
    """
    import numpy as np

    from minirt.image import Image

    own_width, own_height = size_of(scene)
    width, height = own_width if width is None else width, own_height if height is None else height
    if width < 1 or height < 1:
        raise RenderError(f"a picture has at least 1x1 pixels, got {width}x{height}")
    pixels = np.empty((height, width, 4), np.uint8)
    light = np.zeros((height, width, 3)) if linear else None
    chosen = renderer(threads, precision, depth, dither)
    if samples == "auto":
        if time is not None:
            chosen.prepare(scene)
        reached = chosen.reach(scene, pixels, *goal(error, time), light)
        return Image.from_bgra(pixels, light, reached)
    if error is not None or time is not None:
        raise RenderError(f"an error or a time needs samples='auto', got {samples}")
    chosen.render(scene, pixels, samples, light)
    return Image.from_bgra(pixels, light)


def goal(error: float | None, time: float | None) -> tuple[float, float]:
    """The error and the time that end a picture, if one of them or neither is given; RenderError unless > 0."""
    for name, value in (("error", error), ("time", time)):
        if value is not None and not value > 0:
            raise RenderError(f"{name} must be > 0, got {value}")
    if error is None:
        error = DEFAULT_ERROR if time is None else 0.0
    return error, inf if time is None else time


@cache
def renderer(
    threads: int | None, precision: str = "double", depth: int | None = None, dither: bool = False
) -> Renderer:
    """A renderer with these threads, precision and depth, that dithers or not, cached for the next picture."""
    from minirt.rendering import Renderer

    return Renderer(threads, precision, depth, dither)
