"""Scenes in PNG pictures: a picture carries the text of its scene and the settings that it was rendered with.

The texts may come from anybody: they are limited in size, and the scene is parsed as any other.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from minirt.errors import FileError
from minirt.helpers import file_io

SUFFIX = ".png"
SCENE, SETTINGS, FOLDER = "miniRT scene", "miniRT settings", "miniRT folder"  # keywords of the texts
LARGEST_PICTURE = 2**30  # bytes of a file
LONGEST_SETTINGS = 2**16
LONGEST_FOLDER = 2**12
LONGEST_WRITTEN = 4 * 2**20  # bytes of a scene that a picture carries


def is_picture(path: str | os.PathLike[str]) -> bool:
    """Whether a file may be a picture with a scene, by its name."""
    return Path(path).suffix.lower() == SUFFIX


def read(path: str | os.PathLike[str], longest: int) -> bytes:
    """Return the text of the scene that a picture carries; FileError without one."""
    found = read_text(path, SCENE, longest)
    if found is None:
        raise FileError(path, "this picture carries no scene; miniRT writes one into each PNG that it renders with -o")
    return found


def settings(path: str | os.PathLike[str]) -> str:
    """Return the settings that a picture was rendered with, as options of the command line; FileError."""
    return (read_text(path, SETTINGS, LONGEST_SETTINGS) or b"").decode("utf-8", "replace")


def folder(path: str | os.PathLike[str]) -> Path:
    """Return the folder of the textures and meshes: the one that the picture names, from its own, if there is one."""
    own = Path(path).parent
    with suppress(FileError, OSError, ValueError):
        named = (read_text(path, FOLDER, LONGEST_FOLDER) or b"").decode()
        if named and not Path(named).is_absolute() and (own / named).is_dir():
            return own / named
    return own


def read_text(path: str | os.PathLike[str], keyword: str, longest: int) -> bytes | None:
    """Return a text of a PNG picture, None where it has none; FileError where it cannot be read."""
    from minirt.formats.png import PngError, texts

    data = file_io.read(path, LARGEST_PICTURE)
    try:
        return texts(data, (keyword,), longest).get(keyword)
    except PngError as error:
        raise FileError(path, str(error)) from None


def texts_for(scene: str, settings: str, folder: str = "") -> dict[str, str]:
    """Return the texts for a picture of a scene; none for a scene that is too long to be carried.

    `folder` is the way from the picture's folder to that of the scene's textures, '' where they are the same.
    """
    if len(scene) > LONGEST_WRITTEN:
        return {}
    return {SCENE: scene, SETTINGS: settings} | ({FOLDER: folder} if folder else {})


def way(picture: str, scene: Path | None) -> str:
    """Return the way from the folder of a picture to that of its scene; '' where they are the same or unknown."""
    try:
        found = (
            os.path.relpath(os.path.realpath(scene.parent), os.path.realpath(Path(picture).parent)) if scene else "."
        )
        text = Path(found).as_posix()
        text.encode()
    except (OSError, ValueError):  # on another drive; or a name that is no UTF-8
        return ""
    return "" if text == "." else text
