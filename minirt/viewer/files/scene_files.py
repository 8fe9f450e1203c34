"""What the viewer writes and reads beside the scene file."""

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
from minirt.viewer.display.painter import Pixels


def numbered(path: Path, suffix: str) -> Path:
    """`name-1.suffix`, or the next number that is free."""
    return next(each for n in count(1) if not (each := path.with_name(f"{path.stem}-{n}{suffix}")).exists())


def save_copy(scene: Scene, path: Path) -> Path:
    """Write the scene beside its file; returns where. SceneError."""
    copy = numbered(path, ".rt")
    save(scene, copy)
    return copy


def save_picture(pixels: Pixels, path: Path) -> Path:
    """Write a picture beside the file of its scene; returns where. RenderError."""
    picture = numbered(path, ".png")
    Image.from_bgra(pixels).save(picture)
    return picture


def keep(path: Path) -> Path:
    """Copy the file as it is beside itself; returns where. SceneError."""
    copy = numbered(path, ".rt")
    try:
        atomic_write.write(copy, path.read_bytes())
    except OSError as error:
        raise file_error(copy, f"cannot be written: {reason(error)}") from None
    return copy


def recover(scene: Scene, path: Path) -> Path:
    """Write unsaved changes beside the file, or where that is not possible into a new folder; returns where."""
    copy = path.with_name(f"{path.stem}.recovered.rt")
    if copy.exists():  # it may hold what somebody still needs
        copy = numbered(copy, ".rt")
    try:
        save(scene, copy)
    except SceneError:
        copy = Path(tempfile.mkdtemp(prefix="minirt-")) / copy.name
        save(scene, copy)
    return copy


def differ(scene: Scene, saved: Scene) -> bool:
    """Whether there is something to lose: another place of the camera is none, or looking around would be."""
    return contents(scene) != contents(saved)


def contents(scene: Scene) -> list[object]:
    """The lines of a scene but for the camera."""
    return [item for item in scene.items if not isinstance(item, Camera)]


def summary(error: MiniRTError) -> str:
    """An error in short: of many problems the first, without the line that it is in."""
    if not isinstance(error, SceneError):
        return str(error)
    first, others = str(error.problems[0]).split("\n")[0], len(error.problems) - 1
    return f"{first}\nand {others} more" if others else first
