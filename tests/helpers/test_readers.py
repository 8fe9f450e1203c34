"""Each reader of files that somebody names refuses what is no regular file of a size that it takes, and opens none."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from unittest.mock import Mock

import pytest

from minirt.errors import MiniRTError
from minirt.materials.pictures import heights, picture
from minirt.meshes import load_mesh
from minirt.scene import load
from tests.guards import must_not_open

READERS: dict[str, tuple[Callable[[Path], object], int, str]] = {  # by the name of a file, with its greatest size
    "scene.rt": (load, 2**26, "64 MiB"),
    "carries a scene.png": (load, 2**30, "1.0 GiB"),
    "colours.png": (picture, 2**28, "256 MiB"),
    "heights.png": (heights, 2**28, "256 MiB"),
    "mesh.obj": (load_mesh, 2**28, "256 MiB"),
    "mesh.stl": (load_mesh, 2**28, "256 MiB"),
}
REFUSED: list[tuple[str, Callable[[Path, int], object], str]] = [  # what precedes the name, what is there, the reason
    ("", lambda path, _: None, "cannot be read: no such file or directory"),
    ("", lambda path, _: path.symlink_to("missing"), "cannot be read: no such file or directory"),
    ("", lambda path, _: path.symlink_to(path.name), "cannot be read: too many levels of symbolic links"),
    ("", lambda path, _: path.mkdir(), "is a folder"),
    ("", lambda path, _: os.mkfifo(path), "is not a regular file"),
    ("", lambda path, _: path.symlink_to("/dev/zero"), "is not a regular file"),
    ("", lambda path, most: path.touch() or os.truncate(path, most + 1), "larger than {}"),
    ("x" * 300, lambda path, _: None, "cannot be read: file name too long"),
    ("a\0b", lambda path, _: None, "cannot be read: no file can have this name"),
    ("\ud800", lambda path, _: None, "cannot be read: no file can have this name"),
]


@pytest.mark.parametrize("name", READERS)
def test_what_is_no_regular_file_is_refused(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    read, most, size = READERS[name]

    def refusal(path: Path) -> str:
        with pytest.raises(MiniRTError) as caught:
            read(path)
        return str(caught.value).rpartition(f"{name}: ")[2]

    for number, (word, make, reason) in enumerate(REFUSED):
        folder = tmp_path / str(number)
        folder.mkdir()
        make(folder / name, most)
        with must_not_open(folder / name):
            assert refusal(folder / f"{word}{name}") == reason.format(size)
    (tmp_path / name).write_bytes(b"content")
    monkeypatch.setattr(Path, "open", Mock(side_effect=PermissionError(13, "Permission denied")))  # root may read it
    assert refusal(tmp_path / name) == "cannot be read: permission denied"
