"""Files that .ply and glTF files name, the pictures in them, and the materials that these pictures belong to."""

from __future__ import annotations

import atexit
import base64
import shutil
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from tempfile import mkdtemp
from urllib.parse import unquote

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.helpers.system import TooLargeError
from minirt.materials import pictures

WHITE = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Look:
    """A material of trimesh, as far as .obj files are written with it."""

    colour: tuple[float, ...] = WHITE
    picture: str = ""
    name: str = "look"

    def to_obj(self, name: str) -> tuple[dict[str, bytes], str]:
        """Return files of materials by their names, and the name of the material in them."""
        lines = [f"newmtl {name}", "Kd {} {} {}".format(*self.colour)]
        if self.picture and any(self.colour):  # times 0 it is black
            lines.append(f"map_Kd {self.picture}")
        return {f"{name}.mtl": "\n".join(lines).encode()}, name

    def copy(self) -> Look:
        """Return the same, which does not change."""
        return self


class Files:
    """The files that a mesh names, and the folder of its pictures."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.contents: dict[str, bytes] = {}
        self.pictures: dict[str, int] = {}  # sizes in bytes, 0 of those that are not there

    def get(self, uri: str) -> bytes:
        """Return the bytes in a URI, or in the file that it names; FileError."""
        if uri.startswith("data:"):
            return self.contents.setdefault(uri, base64.b64decode(uri.partition(",")[2]))
        if uri not in self.contents:
            try:
                self.contents[uri] = file_io.read(self.path.parent / unquote(uri), file_io.LARGEST_ASSET)
            except FileError as error:
                raise FileError(self.path, f"names a file that cannot be used: {error.reason}") from None
            file_io.check_size(self.path, sum(map(len, self.contents.values())), file_io.LARGEST_ASSET)
        return self.contents[uri]

    __getitem__ = get

    def add_picture(self, name: str, uri: str, part: slice = slice(None)) -> None:
        """Write a picture, a part of the bytes of a URI, into the folder unless it is not there; FileError."""
        is_there = uri in self.contents or uri.startswith("data:") or file_io.found(self.path.parent / unquote(uri))
        data = self.get(uri)[part] if is_there else b""
        self.pictures[name] = len(data)
        file_io.check_size(self.path, sum(self.pictures.values()), file_io.LARGEST_ASSET)
        if is_there:
            (self.folder / name).write_bytes(data)

    def check_pictures(self) -> None:
        """Check the pictures by their headers; FileError."""
        try:
            pictures.check_headers(self.folder / name for name, size in self.pictures.items() if size)
        except FileError as error:
            raise FileError(self.path, f"has a picture that cannot be used: {error.reason}") from None
        except TooLargeError as error:
            raise FileError(self.path, str(error)) from None

    @cached_property
    def folder(self) -> Path:
        """A folder that is deleted at the end of this process."""
        folder = Path(mkdtemp(prefix="minirt-"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        return folder
