"""Scene files and the scenes that PNG pictures carry: their names, bytes and text.

A picture that miniRT writes carries the text of its scene and the settings that it was rendered with. Such texts may
come from anybody: they are limited in size, and the scene is parsed as any other.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from minirt.errors import FileError, Problem, SceneError
from minirt.helpers import file_io

SUFFIX = ".rt"
MAX_BYTES = 64 * 2**20  # 64 MiB
MAX_LINES = MAX_BYTES // 16  # the line of a shape has more than 16 bytes

NO_ELEMENTS = "holds only blanks and comments"
NO_SCENE = "this picture carries no scene; miniRT writes one into each PNG that it renders with -o"

UTF16 = (b"\xff\xfe", b"\xfe\xff")  # byte order marks

PICTURE_SUFFIX = ".png"
SCENE, SETTINGS, FOLDER = "miniRT scene", "miniRT settings", "miniRT folder"  # keywords of the texts
LARGEST_PICTURE = 2**30  # bytes of a file
LONGEST_SETTINGS = 2**16
LONGEST_FOLDER = 2**12
LONGEST_WRITTEN = 4 * 2**20  # bytes of a scene that a picture carries


def is_picture(path: str | os.PathLike[str]) -> bool:
    """Whether a file may be a picture with a scene, by its name."""
    return Path(path).suffix.lower() == PICTURE_SUFFIX


def picture_settings(path: str | os.PathLike[str]) -> str:
    """Return the settings that a picture was rendered with, as options of the command line; FileError."""
    return (read_picture_text(path, SETTINGS, LONGEST_SETTINGS) or b"").decode("utf-8", "replace")


def picture_folder(path: str | os.PathLike[str]) -> Path:
    """Return the folder of the textures and meshes: the one that the picture names, from its own, if there is one."""
    own = Path(path).parent
    with suppress(FileError, OSError, ValueError):
        named = (read_picture_text(path, FOLDER, LONGEST_FOLDER) or b"").decode()
        if named and not Path(named).is_absolute() and file_io.is_folder(own / named):
            return own / named
    return own


def read_picture_text(path: str | os.PathLike[str], keyword: str, longest: int) -> bytes | None:
    """Return a text of a PNG picture, None where it has none; FileError where it cannot be read."""
    from minirt.formats.png import PngError, text

    data = file_io.read(path, LARGEST_PICTURE)
    try:
        return text(data, keyword, longest)
    except PngError as error:
        raise FileError(path, str(error)) from None


def picture_texts(scene: str, settings: str, folder: str = "") -> dict[str, str]:
    """Return the texts for a picture of a scene; none for a scene that is too long to be carried.

    `folder` is the way from the picture's folder to that of the scene's textures, '' where they are the same.
    """
    if len(scene) > LONGEST_WRITTEN:
        return {}
    return {SCENE: scene, SETTINGS: settings} | ({FOLDER: folder} if folder else {})


def way_to_scene(picture: str, scene: Path | None) -> str:
    """Return the way from the folder of a picture to that of its scene; '' where they are the same or unknown."""
    try:
        folder = os.path.realpath(Path(picture).parent)
        text = Path(os.path.relpath(os.path.realpath(scene.parent), folder) if scene else ".").as_posix()
        text.encode()
    except (OSError, ValueError):  # on another drive; or a name that is no UTF-8
        return ""
    return "" if text == "." else text


def file_error(path: str | os.PathLike[str], message: str) -> SceneError:
    """Return an error about a file as a whole, without a line."""
    return SceneError((Problem(os.fspath(path), 0, 0, "", message),))


def check_name(path: str | os.PathLike[str]) -> None:
    """Check that the file name ends in `.rt` and is more than that; SceneError otherwise."""
    if is_picture(path):
        raise file_error(path, "a scene is not written over its picture; Ctrl+Shift+S in the window writes a copy")
    name = Path(path).name
    if not name.endswith(SUFFIX) or name == SUFFIX:
        is_folder = name and file_io.is_folder(path)
        raise file_error(path, "is a folder" if is_folder else f"the name of a scene file ends in '{SUFFIX}'")


def is_absent(path: str | os.PathLike[str]) -> bool:
    """Whether a path is that of a scene file which is not there, in a folder that is."""
    return Path(path).suffix == SUFFIX and file_io.is_absent(path)


def read(path: str | os.PathLike[str]) -> bytes:
    """Return the bytes of a scene file, or of the scene in a PNG picture; SceneError when it cannot be read."""
    if not is_picture(path):
        check_name(path)
    try:
        data = read_picture_text(path, SCENE, MAX_BYTES) if is_picture(path) else file_io.read(path, MAX_BYTES)
        if data is None:
            raise FileError(path, NO_SCENE)
        return data
    except FileError as error:
        raise file_error(path, error.reason) from None


def decode(data: bytes, file: str) -> str:
    """Return the text of a scene file; SceneError when it is empty, not UTF-8 text, or of too many lines."""
    if not data.strip():
        raise file_error(file, NO_ELEMENTS if data else "is empty")
    if data.startswith(UTF16):
        raise byte_error(data, 0, file, "must be UTF-8, got UTF-16")
    nul = data.find(b"\0")
    if nul >= 0:
        raise byte_error(data, nul, file, "must be text, got a NUL byte")
    try:
        text = data.decode()
    except UnicodeDecodeError as error:
        raise byte_error(data, error.start, file, f"must be UTF-8, got the byte 0x{data[error.start]:02x}") from None
    if (lines := text.count("\n")) > MAX_LINES:
        raise file_error(file, f"has {lines:,} lines, more than {MAX_LINES:,}")
    return text


def byte_error(data: bytes, index: int, file: str, message: str) -> SceneError:
    """Return an error about the byte at `index`, with its line and column."""
    begin, end = data.rfind(b"\n", 0, index) + 1, data.find(b"\n", index)
    parts = data[begin:index], data[begin : end if end >= 0 else len(data)]
    before, line = (part.decode("utf-8" if begin else "utf-8-sig", "replace") for part in parts)
    return SceneError((Problem(file, data.count(b"\n", 0, index) + 1, len(before) + 1, line, message),))
