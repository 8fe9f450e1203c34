"""Files beside the scene's file: copies, screenshots, recovery of unsaved changes."""

from __future__ import annotations

import tempfile
from contextlib import suppress
from itertools import chain, count
from pathlib import Path

from minirt.errors import FileError, MiniRTError, RenderError, SceneError
from minirt.helpers import file_io
from minirt.helpers.file_io import reason
from minirt.image import Image
from minirt.scene import Camera, Scene, dump
from minirt.scene.files import MAX_BYTES, SUFFIX, file_error


def create_numbered(path: Path, suffix: str, data: bytes, first: Path | None = None) -> Path:
    """Write a new file `name-1.suffix`, or with the first number that no file has; return its path. OSError.

    `first` is a name to try before. No other program's file is ever replaced, even one that is written just now.
    """
    numbered = (path.with_name(f"{path.stem}-{n}{suffix}") for n in count(1))
    for each in chain([first] if first else [], numbered):
        with suppress(FileExistsError):
            file_io.create(each, data)
            return each
    raise AssertionError("there are endlessly many numbers")


def save_copy(scene: Scene, path: Path) -> Path:
    """Write the scene to a new file beside its own; return the new path. SceneError."""
    return create_scene_file(path, dump(scene).encode())


def create_scene_file(path: Path, data: bytes, first: Path | None = None) -> Path:
    """Write a new scene file beside another one; return its path. SceneError."""
    try:
        return create_numbered(path, SUFFIX, data, first)
    except OSError as error:
        raise file_error(first or path, f"cannot be written: {reason(error)}") from None


def save_picture(image: Image, path: Path) -> Path:
    """Write a picture beside the scene's file; return its path. RenderError."""
    try:
        return create_numbered(path, ".png", image.encode())
    except OSError as error:
        raise RenderError(f"{path.with_suffix('.png')}: cannot write: {reason(error)}") from None


def back_up(path: Path) -> Path:
    """Copy a file, byte for byte, to a new file beside it; return the new path. SceneError."""
    try:
        data = file_io.read(path, MAX_BYTES)
    except FileError as error:
        raise file_error(path, error.reason) from None
    return create_scene_file(path, data)


def save_recovery(scene: Scene, path: Path) -> Path:
    """Write unsaved changes beside the file, or if that fails into a new temporary folder; return the path."""
    name = f"{path.stem}.recovered{SUFFIX}"
    data = dump(scene).encode()
    try:
        return create_scene_file(path.with_name(name), data, path.with_name(name))
    except SceneError:
        folder = Path(tempfile.mkdtemp(prefix="minirt-"))
        return create_scene_file(folder / name, data, folder / name)


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
