"""The pictures and meshes beside a scene, for what takes one: files in its folder and in the folders there."""

from __future__ import annotations

from collections.abc import Iterator, Set
from pathlib import Path

from minirt.errors import FieldError, FileError
from minirt.fields import MeshFile
from minirt.fields.pictures import file_name
from minirt.meshes import load_mesh
from minirt.scene import Scene

SUFFIXES = {".png", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff", ".ppm", ".tga", ".webp", ".xpm"}
MESHES = {".obj"}


def names(scene: Scene, suffixes: Set[str] = SUFFIXES) -> list[str]:
    """As lines of the scene name them: those in its own folder first."""
    folder = scene.beside("")
    inside = sorted(each for each in children(folder) if each.is_dir() and not each.name.startswith("."))
    files = [each for room in (folder, *inside) for each in sorted(children(room)) if each.suffix.lower() in suffixes]
    return [each.relative_to(folder).as_posix() for each in files]


def children(folder: Path) -> list[Path]:
    """What is in a folder; nothing where that cannot be read."""
    try:
        return list(folder.iterdir())
    except OSError:
        return []


def usable(scene: Scene, name: str) -> bool:
    """Whether a line can name it, and it holds a picture."""
    from minirt.materials.picture_cache import picture  # with numpy and Pillow, which no other key needs

    try:
        picture(scene.beside(file_name(name, ",")))
    except (FieldError, FileError):
        return False
    return True


def pictures(scene: Scene) -> Iterator[str]:
    """Those that can be used."""
    return (name for name in names(scene) if usable(scene, name))


def read_mesh(scene: Scene, name: str) -> MeshFile | None:
    """The mesh in a file, where a line can name it and it holds one."""
    try:
        return MeshFile(file_name(name), load_mesh(scene.beside(name)))
    except (FieldError, FileError):
        return None


def meshes(scene: Scene) -> Iterator[MeshFile]:
    """Those that can be used."""
    return filter(None, (read_mesh(scene, name) for name in names(scene, MESHES)))


def another(scene: Scene, file: str | MeshFile, steps: float) -> str | MeshFile:
    """The next picture that can be used, or mesh, or with negative `steps` the previous one, round and round."""
    if isinstance(file, MeshFile):
        around = ring(names(scene, MESHES), file.name, steps)
        return next(filter(None, (read_mesh(scene, each) for each in around)), file)
    return next((each for each in ring(names(scene), file, steps) if usable(scene, each)), file)


def ring(known: list[str], name: str, steps: float) -> list[str]:
    """All names from the one behind `name` on, or with negative `steps` backwards."""
    if steps < 0:
        known.reverse()
    behind = known.index(name) + 1 if name in known else 0
    return known[behind:] + known[:behind]
