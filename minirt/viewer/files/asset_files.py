"""Texture and mesh files in the scene's folder and its sub-folders, from which the editor chooses."""

from __future__ import annotations

from collections.abc import Iterator, Set
from pathlib import Path

from minirt.errors import FieldError, FileError
from minirt.fields import MeshFile
from minirt.fields.field import file_name
from minirt.meshes import load_mesh
from minirt.scene import Scene

PICTURE_SUFFIXES = {".png", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff", ".ppm", ".tga", ".webp", ".xpm"}
MESH_SUFFIXES = {".obj"}


def asset_names(scene: Scene, suffixes: Set[str] = PICTURE_SUFFIXES) -> list[str]:
    """Return the files with these suffixes, relative to the scene's folder, those in the folder itself first."""
    top = scene.beside("")
    inside = sorted(each for each in children(top) if each.is_dir() and not each.name.startswith("."))
    files = [each for folder in (top, *inside) for each in sorted(children(folder)) if each.suffix.lower() in suffixes]
    return [each.relative_to(top).as_posix() for each in files]


def children(folder: Path) -> list[Path]:
    """Return the entries of a folder; an empty list if it cannot be read."""
    try:
        return list(folder.iterdir())
    except OSError:
        return []


def is_usable_picture(scene: Scene, name: str) -> bool:
    """Whether a scene line can spell the name and the file holds a picture."""
    from minirt.materials.picture_cache import picture  # loads numpy and Pillow, which no other key needs

    try:
        picture(scene.beside(file_name(name, ",")))
    except (FieldError, FileError):
        return False
    return True


def pictures(scene: Scene) -> Iterator[str]:
    """Yield the names of the usable pictures."""
    return (name for name in asset_names(scene) if is_usable_picture(scene, name))


def read_mesh(scene: Scene, name: str) -> MeshFile | None:
    """Read a mesh; None if a scene line cannot spell the name or the file holds no mesh."""
    try:
        return MeshFile(file_name(name), load_mesh(scene.beside(name)))
    except (FieldError, FileError):
        return None


def meshes(scene: Scene) -> Iterator[MeshFile]:
    """Yield the usable meshes."""
    return filter(None, (read_mesh(scene, name) for name in asset_names(scene, MESH_SUFFIXES)))


def next_file(scene: Scene, file: str | MeshFile, steps: float) -> str | MeshFile:
    """Return the next usable picture or mesh after `file`, cyclically; the previous one if `steps` is negative."""
    if isinstance(file, MeshFile):
        candidates = cycle_after(asset_names(scene, MESH_SUFFIXES), file.name, steps)
        return next(filter(None, (read_mesh(scene, each) for each in candidates)), file)
    return next((each for each in cycle_after(asset_names(scene), file, steps) if is_usable_picture(scene, each)), file)


def cycle_after(names: list[str], name: str, steps: float) -> list[str]:
    """Return all names in cyclic order from the one after `name`; in reverse order if `steps` is negative."""
    if steps < 0:
        names.reverse()
    start = names.index(name) + 1 if name in names else 0
    return names[start:] + names[:start]
