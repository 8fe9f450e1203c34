"""Files beside the scene's file: copies, screenshots, recovery of unsaved changes."""

from __future__ import annotations

import tempfile
from itertools import count
from pathlib import Path

from minirt import atomic_write
from minirt.errors import MiniRTError, SceneError
from minirt.image import Image
from minirt.regular_files import reason
from minirt.scene import Camera, Scene, save
from minirt.scene.files import file_error


def free_path(path: Path, suffix: str) -> Path:
    """Return `name-1.suffix`, or the path with the next number that no file has."""
    return next(each for n in count(1) if not (each := path.with_name(f"{path.stem}-{n}{suffix}")).exists())


def save_copy(scene: Scene, path: Path) -> Path:
    """Write the scene to a new file beside its own; return the new path. SceneError."""
    copy = free_path(path, ".rt")
    save(scene, copy)
    return copy


def save_picture(image: Image, path: Path) -> Path:
    """Write a picture beside the scene's file; return its path. RenderError."""
    picture = free_path(path, ".png")
    image.save(picture)
    return picture


def back_up(path: Path) -> Path:
    """Copy a file, byte for byte, to a new file beside it; return the new path. SceneError."""
    copy = free_path(path, ".rt")
    try:
        atomic_write.write(copy, path.read_bytes())
    except OSError as error:
        raise file_error(copy, f"cannot be written: {reason(error)}") from None
    return copy


def save_recovery(scene: Scene, path: Path) -> Path:
    """Write unsaved changes beside the file, or if that fails into a new temporary folder; return the path."""
    copy = path.with_name(f"{path.stem}.recovered.rt")
    if copy.exists():  # the user may still need an older recovery file
        copy = free_path(copy, ".rt")
    try:
        save(scene, copy)
    except SceneError:
        copy = Path(tempfile.mkdtemp(prefix="minirt-")) / copy.name
        save(scene, copy)
    return copy


def contents_differ(scene: Scene, saved: Scene) -> bool:
    """Whether two scenes differ in more than the camera: looking around is not an unsaved change."""
    return contents(scene) != contents(saved)


def contents(scene: Scene) -> list[object]:
    """Return the lines of a scene, without the camera's."""
    return [item for item in scene.items if not isinstance(item, Camera)]


def error_summary(error: MiniRTError) -> str:
    """Return the first problem of an error without the quoted line, and the number of further problems."""
    if not isinstance(error, SceneError):
        return str(error)
    first, others = str(error.problems[0]).split("\n")[0], len(error.problems) - 1
    return f"{first}\nand {others} more" if others else first
