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

TYPE_CHECKING = False  # as in `typing`, whose import would take as long as all others
if TYPE_CHECKING:  # the same names for type checkers, which see no `__getattr__`
    from typing import Any

    from minirt.public_names import *  # noqa: F403  # a stub, written by `python -m tests.make_tables`
    from minirt.scene import Scene

__version__ = "0.1.0"

REGISTRIES = "minirt.shapes", "minirt.materials", "minirt.scene.elements"  # whose `PUBLIC` names are public here, too
OWN = ("load",)
# The modules of the other names. At run time they are imported on first use, so that `miniRT --help` need not wait.
HOMES = {
    name: module
    for module, names in {
        "minirt.cluster.pictures": "render_all render_to",
        "minirt.compare": "Comparison compare",
        "minirt.element": "Element",
        "minirt.errors": "ElementError FileError MiniRTError MlxError Problem RenderError ReplayError SceneError",
        "minirt.fields": "MeshFile Triple",
        "minirt.helpers.system": "TooLargeError limit_memory",
        "minirt.movie": "save_movie",
        "minirt.notebook": "view",
        "minirt.rendering.buffers": "Buffers buffers",
        "minirt.rendering.image": "Image LinearImage",
        "minirt.rendering.outcome": "Outcome",
        "minirt.rendering.queries.explain": "explain",
        "minirt.rendering.queries.explanation": "Explanation",
        "minirt.rendering.queries.rays": "Hits camera_rays trace",
        "minirt.rendering.renderer": "Renderer renderer",
        "minirt.rendering.settings": "DEFAULT_ERROR render",
        "minirt.scene": "DEFAULT_SIZE Scene dumps loads size_of",
        "minirt.scene.examples": "example examples",
        "minirt.shapes": "Shape",
    }.items()
    for name in names.split()
}

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
    return sorted({*OWN, *HOMES, *registered()})


@cache
def registered() -> dict[str, type]:
    """The shapes, materials and lights by their public names: `minirt.Sphere`, `minirt.Glass`, `minirt.Light`."""
    return {name: kind for home in REGISTRIES for name, kind in import_module(home).PUBLIC.items()}


def load(path: str | os.PathLike[str], lenient: bool | str = False, left_handed: bool = False) -> Scene:
    """Return the scene of a file. SceneError, with all of its problems, if the file is not a valid scene.

    `lenient` accepts older spellings (several `L`, blanks around commas, colours with decimals) and translates lines of
    other programs; `scene.missing` has the lines of shapes that could not be read. Words in place of True, such as
    "base z-up", do so, too, and read fields in another way. Cones: "base", whose point is the centre of the base;
    "angle", whose diameter is half the angle at the apex, in degrees. Cameras: "reversed", whose direction points
    backwards; "angles", whose direction is three angles, by which a camera along +z is turned about x, y and z (shares
    of 180 degrees; where one is beyond 1 radians, beyond 2 pi degrees); "z-up", rolled so that z is up in the picture.
    ValueError for other words.

    `left_handed` mirrors pictures of the scene, as renderers with left-handed coordinates do.
    """
    from minirt.scene import load as read

    return read(path, lenient, left_handed).scene
