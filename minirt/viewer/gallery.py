"""The picture files beside a scene, for what takes one: those in its folder and in the folders there."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from minirt.errors import FieldError, FileError
from minirt.fields.pictures import file_name
from minirt.scene import Scene

SUFFIXES = {".png", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff", ".ppm", ".tga", ".webp", ".xpm"}


def names(scene: Scene) -> list[str]:
    """As lines of the scene name them: those in its own folder first."""
    folder = scene.beside("")
    inside = sorted(each for each in children(folder) if each.is_dir() and not each.name.startswith("."))
    files = [each for room in (folder, *inside) for each in sorted(children(room)) if each.suffix.lower() in SUFFIXES]
    return [each.relative_to(folder).as_posix() for each in files]


def children(folder: Path) -> list[Path]:
    """What is in a folder; nothing where that cannot be read."""
    try:
        return list(folder.iterdir())
    except OSError:
        return []


def usable(scene: Scene, name: str) -> bool:
    """Whether a line can name it, and it holds a picture."""
    from minirt.materials.pictures import picture  # with numpy and Pillow, which no other key needs

    try:
        picture(scene.beside(file_name(name, ",")))
    except (FieldError, FileError):
        return False
    return True


def pictures(scene: Scene) -> Iterator[str]:
    """Those that can be used."""
    return (name for name in names(scene) if usable(scene, name))


def another(scene: Scene, name: str, steps: float) -> str:
    """The next one that can be used, or with negative `steps` the previous one, round and round."""
    known = names(scene)
    if steps < 0:
        known.reverse()
    behind = known.index(name) + 1 if name in known else 0
    around = known[behind:] + known[:behind]
    return next((each for each in around if usable(scene, each)), name)
