"""Example scenes, which are installed with the library: `minirt.example("demo")`."""

from __future__ import annotations

import re
from pathlib import Path

from minirt.errors import FileError, nearest
from minirt.helpers import file_io
from minirt.scene.parser import load, parse
from minirt.scene.scene import Scene

# Example scenes, which are installed with the library: `minirt.example("demo")`.

PACKAGE = Path(__file__).parents[1]
FOLDERS = (PACKAGE / "scenes", PACKAGE.parent / "scenes")  # of a wheel, and beside the sources
FILE = re.compile(r"(?<=[\s:])(?:textures|meshes)/[^\s,#]+")  # that a line of an example names, or its comment
UNFIT = re.compile(r"[\s,#]")  # in a path: no line of a scene can name it


def folder() -> Path:
    """Return the folder of the example scenes; FileError where none was installed."""
    for each in FOLDERS:
        if file_io.is_file(each / "demo.rt"):
            return each
    raise FileError(FOLDERS[0], "the example scenes are not installed")


def examples() -> list[str]:
    """Return the names of the example scenes, in alphabetical order.

    FileError where they are not installed.

        minirt.examples()  # ["demo", "eval-camera-elsewhere", ...]
    """
    return sorted(path.stem for path in folder().glob("*.rt"))


def example(name: str = "opening") -> Scene:
    """Return an example scene by its name.

    The scene belongs to no file, and names its textures and meshes by their absolute paths, so that it can be saved
    anywhere. (Where no line can hold these paths it belongs to the example's file.) FileError for an unknown name, with
    the names that are like it.

        minirt.render(minirt.example("gallery-chess"), 640, 480).save("chess.png")
    """
    known = examples()
    if name not in known:
        near = nearest(name, known, count=3)
        hint = f"did you mean {' or '.join(near)}?" if near else f"the examples are {', '.join(known)}"
        raise FileError(name, f"there is no such example scene; {hint}")
    path = folder() / f"{name}.rt"
    if UNFIT.search(str(path.parent)):
        return load(path).scene
    text = path.read_text(encoding="utf-8")
    return parse(FILE.sub(lambda named: str(folder() / named[0]), text)).scene
