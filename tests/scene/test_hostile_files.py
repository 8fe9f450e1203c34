"""Whatever has the name of a picture or a mesh, the message has its line, its column and the reason."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from minirt.errors import SceneError
from minirt.scene import load

HEAD = "A 0.2 255,255,255\nC 0,0,-5 0,0,1 70\n"
LINES = {  # by the column of the name
    "sp 0,0,0 2 10,0,255 texture:": 29,
    "sp 0,0,0 2 10,0,255 normal:": 28,
    "sp 0,0,0 2 10,0,255 bump:": 26,
    "bg ": 4,
    "ob ": 4,
}


def link_to(target: str) -> Callable[[Path], object]:
    """Return what makes a symbolic link to a target."""
    return lambda path: path.symlink_to(target)


def link_to_fifo(path: Path) -> None:
    os.mkfifo(path.with_name("fifo"))
    path.symlink_to("fifo")


def links_in_a_circle(path: Path) -> None:
    path.with_name("other").symlink_to(path)
    path.symlink_to("other")


HOSTILE: dict[str, tuple[Callable[[Path], object], str]] = {
    "folder": (Path.mkdir, "is a folder"),
    "FIFO": (os.mkfifo, "is not a regular file"),
    "link to a FIFO": (link_to_fifo, "is not a regular file"),
    "link to a device": (link_to("/dev/zero"), "is not a regular file"),
    "link to itself": (link_to("x"), "cannot be read: too many levels of symbolic links"),
    "circle of links": (links_in_a_circle, "cannot be read: too many levels of symbolic links"),
    "link to nothing": (link_to("missing"), "cannot be read: no such file or directory"),
    "memory of the program": (link_to("/proc/self/mem"), "cannot be read: input/output error"),
}

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="/proc and the words of Linux")


@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("name", HOSTILE)
def test_what_is_no_ordinary_file_is_refused_with_its_place(tmp_path: Path, name: str, line: str) -> None:
    make, reason = HOSTILE[name]
    make(tmp_path / "x")
    scene = tmp_path / "scene.rt"
    scene.write_text(f"{HEAD}{line}x{' 0,0,0 1 9,9,9' if line == 'ob ' else ''}\n")
    with pytest.raises(SceneError) as caught:
        load(scene)
    (problem,) = caught.value.problems
    assert (problem.line, problem.column) == (3, LINES[line])
    assert "got 'x': " in problem.message
    assert problem.message.endswith(reason)
